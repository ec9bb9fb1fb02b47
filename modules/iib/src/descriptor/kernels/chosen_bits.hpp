// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../../precomp.hpp"

namespace cv {
namespace iib {

//! The chosen bits of a phase (paper, "Reduction of the IIB Descriptor Size"), in their order.
class ChosenBits
{
public:
    //! Some that lie in SIZE bytes of comparisons.
    struct Group
    {
        static constexpr int SIZE = 16;
        size_t byte;         //!< the first of those bytes
        int count;           //!< bits, up to SIZE
        uchar places[SIZE];  //!< bytes of the bits, counted from the first; 128 if there is no bit
        uchar masks[SIZE];   //!< the bits in their bytes; 1 if there is none
    };

    //! @param masks a bit for each comparison of the phase, where the comparison lies in memory.
    explicit ChosenBits(const std::vector<uint64>& masks)
    {
        for (size_t bit = 0; bit < 64 * masks.size(); bit++)
        {
            if (!(masks[bit / 64] >> bit % 64 & 1))
                continue;
            const size_t byte = bit / 8;
            if (none() || chosen.back().count == Group::SIZE || byte - chosen.back().byte >= Group::SIZE)
            {
                Group next = {byte, 0, {}, {}};
                std::fill_n(next.places, (int)Group::SIZE, (uchar)128);
                std::fill_n(next.masks, (int)Group::SIZE, (uchar)1);
                chosen.push_back(next);
            }
            Group& group = chosen.back();
            group.places[group.count] = (uchar)(byte - group.byte);
            group.masks[group.count++] = (uchar)(1 << bit % 8);
        }
    }

    bool none() const { return chosen.empty(); }
    const std::vector<Group>& groups() const { return chosen; }

private:
    std::vector<Group> chosen;
};

}  // namespace iib
}  // namespace cv
