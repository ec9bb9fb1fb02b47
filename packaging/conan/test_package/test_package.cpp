#include <opencv2/iib.hpp>
#include <iostream>

int main()
{
    cv::Ptr<cv::iib::IIB> iib = cv::iib::IIB::create();
    std::cout << iib->descriptorSize() << " bytes a descriptor\n";
    return 0;
}
