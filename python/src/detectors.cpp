// SPDX-License-Identifier: Apache-2.0

#include "bindings.hpp"
#include "held.hpp"

#include "opencv2/iib.hpp"

namespace iib_python {

namespace {

typedef cv::iib::NormalizedDetector Normalized;
typedef cv::iib::HessianDetector Hessian;

//! A detector of Python, for instance of another cv2, as this OpenCV's Feature2D. `function(image, mask or None)` gets copies, since a detector
//! may keep them, and returns rows of keypoints (arrays.hpp). Any thread may call it.
class ForeignDetector CV_FINAL : public cv::Feature2D
{
public:
    ForeignDetector(nb::callable function_, const std::string& name_) : function(function_), name(name_) {}
    ~ForeignDetector()
    {
        nb::gil_scoped_acquire gil;
        function.reset();
    }

    void detect(cv::InputArray image, std::vector<cv::KeyPoint>& keypoints, cv::InputArray mask) CV_OVERRIDE
    {
        nb::gil_scoped_acquire gil;
        const cv::Mat allowed = mask.getMat();
        const nb::object rows = function(
                toNumpy(image.getMat().clone()), allowed.empty() ? nb::none() : toNumpy(allowed.clone()));
        keypoints = nb::cast<std::vector<cv::KeyPoint>>(rows);
    }
    bool empty() const CV_OVERRIDE { return false; }
    cv::String getDefaultName() const CV_OVERRIDE { return "Feature2D." + name; }

private:
    nb::object function;
    std::string name;
};

//! @param mask empty: everywhere.
std::vector<cv::KeyPoint> detect(const Detector& self, const cv::Mat& image, const cv::Mat& mask)
{
    std::vector<cv::KeyPoint> keypoints;
    if (!image.empty())
        self->detect(image, keypoints, mask);
    return keypoints;
}

// In Python, since it takes lists of images too, and returns objects of cv2 if it is installed.
nb::object detected(nb::handle self, nb::handle image, nb::handle mask)
{
    return nb::module_::import_("opencv_iib.detectors").attr("detected")(self, image, mask);
}

const char* const DETECT = "def detect(self, image: numpy.typing.ArrayLike, "
                           "mask: typing.Optional[numpy.typing.ArrayLike] = None) -> tuple[typing.Any, ...]";

const char* const DETECT_DOC =
        R"(Keypoints, as cv2.KeyPoint if cv2 is installed; for a list of images, a tuple for each.

:param mask: H x W uint8, 0 where no points may be found; a list for a list of images.)";

void newHessian(HeldDetector<Hessian>* self, int maxFeatures, float threshold, int scales, float sigma,
        float normalizationSigma, int workingSize)
{
    new (self) HeldDetector<Hessian>(
            Hessian::create(maxFeatures, threshold, scales, sigma, normalizationSigma, workingSize));
}

const char* const NEW_HESSIAN =
        "def __init__(self, maxFeatures: int = 1000, threshold: float = 0.0, scales: int = 5, "
        "sigma: float = 2.2, normalizationSigma: float = 5.0, workingSize: int = 1024) -> None";

}  // namespace

void bindDetectors(nb::module_& m)
{
    nb::class_<Detector> any(m, "Detector", "The base of the detectors and the descriptor.");
    any.def_static("_foreign",
               [](nb::callable function, const std::string& name) {
                   return Detector{cv::makePtr<ForeignDetector>(function, name)};
               })
            .def("_detect", &detect, WithoutGil())
            .def("detect", &detected, nb::arg().none(), nb::arg().none(), nb::sig(DETECT), DETECT_DOC)
            .def(
                    "getDefaultName",
                    [](const Detector& self) { return std::string(self->getDefaultName()); },
                    "The name of its parameters in files, such as Feature2D.IIB.");
    method(any, "descriptorSize", &cv::Feature2D::descriptorSize,
            "Bytes of a descriptor; 0 of a detector that describes nothing.");
    method(any, "empty", &cv::Feature2D::empty, "False: it is always ready.");

    nb::class_<HeldDetector<Normalized>, Detector> normalized(m, "NormalizedDetector");
    sharing(normalized);
    normalized.def("__init__", [](HeldDetector<Normalized>* self, const Detector& detector, float sigma) {
        new (self) HeldDetector<Normalized>(Normalized::create(detector.held, sigma));
    });
    property(normalized, "Sigma", &Normalized::getSigma, &Normalized::setSigma,
            "Sigma of the Gaussian filter in pixels, 1 to 256.");

    nb::class_<HeldDetector<Hessian>, Detector> hessian(m, "HessianDetector");
    sharing(hessian);
    hessian.def("__init__", &newHessian, nb::sig(NEW_HESSIAN),
            "Creates a detector with the parameters of the setters.");
    property(hessian, "MaxFeatures", &Hessian::getMaxFeatures, &Hessian::setMaxFeatures,
            "The strongest that are kept; 0 keeps all.");
    property(hessian, "Threshold", &Hessian::getThreshold, &Hessian::setThreshold,
            "Smallest response, 0 or more.");
    property(hessian, "Scales", &Hessian::getScales, &Hessian::setScales,
            "Number of scales, 1 to 8, each sqrt(2) times the one before.");
    property(hessian, "Sigma", &Hessian::getSigma, &Hessian::setSigma,
            "Sigma of the smallest scale in pixels, 1.5 to 8.");
    property(hessian, "NormalizationSigma", &Hessian::getNormalizationSigma, &Hessian::setNormalizationSigma,
            "Sigma of the local normalization's Gaussian in pixels of the (reduced) image, 2 to 256.");
    property(hessian, "WorkingSize", &Hessian::getWorkingSize, &Hessian::setWorkingSize,
            "Longer side of images in pixels, 64 or more; larger ones are reduced by a whole factor, "
            "and keypoints are in the image's own pixels. 0 never reduces.");
}

}  // namespace iib_python
