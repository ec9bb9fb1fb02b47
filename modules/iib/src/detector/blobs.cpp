// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "blobs.hpp"

#include "../common/file_numbers.hpp"
#include "scale_space.hpp"

#include <tuple>

namespace cv { namespace iib {

namespace {

const int LEAST_ROWS = 32;  // of a part, since it smooths about 20 rows more above

//! Scales from this sigma on, in pixels, are searched at half the resolution.
const double LEAST_HALVED_SIGMA = 4;

//! A pixel with the largest response among its neighbours in place and scale.
struct Extremum
{
    float response;
    int scale, y, x;     //!< in pixels of its octave
    float around[3][3];  //!< responses around the pixel
    //! Responses of the scales before and after; those of the first and last scale have `response`.
    float smaller, larger;
};

//! Sorts by response, strongest first, then by scale and place.
bool isBefore(const Extremum& a, const Extremum& b)
{
    return std::tie(b.response, a.scale, a.y, a.x) < std::tie(a.response, b.scale, b.y, b.x);
}

class BlobFinder
{
public:
    BlobFinder(const Mat& normalized_, const HessianParameters& p, const Mat& mask_, int reduction_)
        : normalized(normalized_), mask(mask_), reduction(reduction_), most(p.maxFeatures),
          threshold(std::max(p.threshold, std::numeric_limits<float>::min())), fine(0)
    {
        for (int i = 0; i < p.scales; i++)
        {
            sigmas.push_back(i == 0 ? p.sigma : sigmas.back() * std::sqrt(2.));
            fine += sigmas.back() < LEAST_HALVED_SIGMA;
        }
        if (fine > 0)
            octaves.push_back(Octave(sigmas, 0, fine, false, normalized.size()));
        if (fine < p.scales)
            octaves.push_back(Octave(sigmas, fine, p.scales, true, normalized.size()));
    }

    //! The strongest extrema of each part of the image, at least maxFeatures in all.
    std::vector<std::vector<Extremum>> extrema() const
    {
        std::vector<Part> parts;
        const int threads = getNumThreads();
        for (int i = 0; i < threads; i++)  // alternate the octaves, to balance the work
            for (const Octave& octave : octaves)
            {
                const int first = octave.borders[octave.begin], rows = octave.size.height - 2 * first;
                const int n = std::max(std::min(threads, rows / LEAST_ROWS), 1);
                if (i < n && rows > 0 && octave.size.width > 2 * first)
                    parts.push_back({&octave, first + rows * i / n, first + rows * (i + 1) / n - 1});
            }
        std::vector<std::vector<Extremum>> found(parts.size());
        parallel_for_(Range(0, (int)parts.size()), [&](const Range& range) {
            for (int i = range.start; i < range.end; i++)
                find(parts[i], found[i]);
        });
        return found;
    }

    //! Refined by quadratic fits of the response, in place and along the scales.
    KeyPoint refined(const Extremum& e) const
    {
        const auto& r = e.around;
        const float c = e.response;
        const float dx = (r[1][2] - r[1][0]) / 2, dy = (r[2][1] - r[0][1]) / 2;
        const float xx = r[1][2] + r[1][0] - 2 * c, yy = r[2][1] + r[0][1] - 2 * c;
        const float xy = (r[2][2] + r[0][0] - r[0][2] - r[2][0]) / 4;
        const float determinant = xx * yy - xy * xy;
        Point2f offset;
        if (determinant > 0)  // else the response has no peak here
            offset = Point2f(within((xy * dy - yy * dx) / determinant, .7f),
                    within((xy * dx - xx * dy) / determinant, .7f));
        const float curvature = e.smaller + e.larger - 2 * c;
        const float step = curvature < 0 ? within((e.smaller - e.larger) / (2 * curvature), .5f) : 0.f;
        // Taylor series of 2^(step / 2): std::exp2 differs between systems
        const float growth = 1 + step * (.34657359f + step * .06005663f);
        Point2f pt((float)e.x + offset.x, (float)e.y + offset.y);
        if (e.scale >= fine)  // the centre of half-resolution pixel x lies between pixels 2 x and 2 x + 1
            pt = 2 * pt + Point2f(.5f, .5f);
        float size = (float)(2 * sigmas[e.scale]) * growth;
        if (reduction > 1)
        {
            const float centre = (reduction - 1) / 2.f;  // of a square of pixels
            pt = (float)reduction * pt + Point2f(centre, centre);
            size *= reduction;
        }
        return KeyPoint(pt, size, -1, e.response, e.scale);
    }

private:
    static float within(float value, float limit) { return std::max(-limit, std::min(limit, value)); }

    //! Rows `first` to `last` of an octave.
    struct Part
    {
        const Octave* octave;
        int first, last;
    };

    void find(const Part& part, std::vector<Extremum>& found) const
    {
        const Octave& octave = *part.octave;
        ScaleSpace space(normalized, octave, part.first);
        const FilterKernels& kernels = filterKernels();
        const int last = (int)octave.sigmas.size() - 1;
        std::vector<int> columns(octave.size.width);
        float least = threshold;  // rises once there are more than maxFeatures
        for (int y = part.first; y <= part.last; y++)
        {
            space.advance(y);
            for (int s = octave.begin; s < octave.end; s++)
            {
                const int border = octave.borders[s];
                if (y < border || y >= octave.size.height - border)
                    break;
                const short* const bounds[] = {space.largest(std::max(s - 1, 0)), space.largest(s),
                        space.largest(std::min(s + 1, last))};
                const int n = kernels.maxima(space.upper(s, y), bounds, upperHalf(least), border,
                        octave.size.width - border, columns.data());
                for (int i = 0; i < n; i++)
                    if (isExtremum(octave, space, s, columns[i], least))
                        add(extremumAt(octave, space, s, y, columns[i]), found);
            }
            if (most > 0 && found.size() >= 2 * most)
            {
                const auto weakest = found.begin() + (most - 1);
                std::nth_element(found.begin(), weakest, found.end(), isBefore);
                least = std::max(least, weakest->response);
                found.resize(most);
            }
        }
    }

    void add(const Extremum& e, std::vector<Extremum>& found) const
    {
        const Point2f pt = mask.empty() ? Point2f() : refined(e).pt;
        if (mask.empty() || mask.at<uchar>(cvRound(pt.y), cvRound(pt.x)))
            found.push_back(e);
    }

    //! Whether a response is at least `least`, larger than earlier neighbours, and not smaller than later ones.
    static bool isExtremum(const Octave& octave, const ScaleSpace& space, size_t s, int x, float least)
    {
        const float* const* rows = space.around(s);
        const float value = rows[1][x];
        const auto largest = [x](const float* r) { return std::max(std::max(r[x - 1], r[x]), r[x + 1]); };
        const auto exceeds = [&](const float* r) { return value > largest(r); };
        const auto reaches = [&](const float* r) { return value >= largest(r); };
        return value >= least && exceeds(rows[0]) && value > rows[1][x - 1] && value >= rows[1][x + 1] &&
               reaches(rows[2]) &&
               (s == 0 || std::all_of(space.around(s - 1), space.around(s - 1) + 3, exceeds)) &&
               (s + 1 == octave.sigmas.size() ||
                       std::all_of(space.around(s + 1), space.around(s + 1) + 3, reaches));
    }

    static Extremum extremumAt(const Octave& octave, const ScaleSpace& space, size_t s, int y, int x)
    {
        Extremum e;
        for (int dy = 0; dy < 3; dy++)
            std::copy_n(space.around(s)[dy] + x - 1, 3, e.around[dy]);
        e.response = e.around[1][1];
        e.scale = octave.first + (int)s;
        e.y = y;
        e.x = x;
        const bool inside = s > 0 && s + 1 < octave.sigmas.size();
        e.smaller = inside ? space.around(s - 1)[1][x] : e.response;
        e.larger = inside ? space.around(s + 1)[1][x] : e.response;
        return e;
    }

    const Mat &normalized, &mask;
    const int reduction;
    const size_t most;
    const float threshold;
    std::vector<double> sigmas;  //!< of all scales, in pixels of `normalized`
    int fine;                    //!< number of scales at full resolution
    std::vector<Octave> octaves;
};

}  // namespace

void HessianParameters::check() const
{
    require(maxFeatures >= 0, "maxFeatures", maxFeatures, "0 (all) or more");
    require(threshold >= 0 && threshold < std::numeric_limits<float>::infinity(), "threshold", threshold,
            "0 or more, and finite");
    require(scales >= 1 && scales <= 8, "scales", scales, "1 to 8");
    require(sigma >= 1.5f && sigma <= 8, "sigma", sigma, "1.5 to 8 pixels");
    require(normalizationSigma >= 2 && normalizationSigma <= 256, "normalizationSigma", normalizationSigma,
            "2 to 256 pixels");
    require(workingSize == 0 || workingSize >= 64, "workingSize", workingSize,
            "64 pixels or more, or 0 (any)");
}

std::vector<KeyPoint> findBlobs(
        const Mat& normalized, const HessianParameters& parameters, const Mat& mask, int reduction)
{
    const BlobFinder finder(normalized, parameters, mask, reduction);
    const std::vector<std::vector<Extremum>> parts = finder.extrema();
    std::vector<const Extremum*> found;
    for (const std::vector<Extremum>& part : parts)
        for (const Extremum& e : part)
            found.push_back(&e);
    const auto before = [](const Extremum* a, const Extremum* b) { return isBefore(*a, *b); };
    const size_t most = parameters.maxFeatures > 0 ? parameters.maxFeatures : found.size();
    std::nth_element(found.begin(), found.begin() + std::min(most, found.size()), found.end(), before);
    found.resize(std::min(most, found.size()));
    std::sort(found.begin(), found.end(), before);
    std::vector<KeyPoint> keypoints;
    keypoints.reserve(found.size());
    for (const Extremum* e : found)
        keypoints.push_back(finder.refined(*e));
    return keypoints;
}

}}  // namespace cv::iib
