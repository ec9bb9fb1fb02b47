// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "blobs.hpp"

#include "scale_space.hpp"

#include <tuple>

namespace cv {
namespace iib {

namespace {

const int LEAST_ROWS = 32;  // a thread's, since it smooths about 20 more above

//! A pixel with the largest response among its neighbours in place and scale.
struct Extremum
{
    float response;
    int scale, y, x;
    float around[3][3];  //!< the responses
    //! Those of the scales before and after at this pixel; of the first and last: its own.
    float smaller, larger;
};

class BlobFinder
{
public:
    BlobFinder(const Mat& normalized_, const HessianParameters& p)
        : normalized(normalized_), threshold(std::max(p.threshold, std::numeric_limits<float>::min()))
    {
        for (int i = 0; i < p.scales; i++)
        {
            sigmas.push_back(i == 0 ? p.sigma / 2. : sigmas.back() * std::sqrt(2.));
            borders.push_back((int)(2 * sigmas.back()) + 2);
        }
        steps = smoothingSteps(sigmas);
    }

    //! In parts of the image.
    std::vector<std::vector<Extremum>> extrema() const
    {
        const int first = borders[0], rows = normalized.rows - 2 * first;
        if (rows <= 0 || normalized.cols <= 2 * first)
            return std::vector<std::vector<Extremum>>();
        const int parts = std::max(std::min(getNumThreads(), rows / LEAST_ROWS), 1);
        std::vector<std::vector<Extremum>> found(parts);
        parallel_for_(Range(0, parts), [&](const Range& range) {
            for (int i = range.start; i < range.end; i++)
                find(first + rows * i / parts, first + rows * (i + 1) / parts - 1, found[i]);
        });
        return found;
    }

    //! Refined by quadratic fits: of the response in place, and of the response along the scales.
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
        // 2^(step / 2), by its Taylor series: std::exp2 differs between systems
        const float growth = 1 + step * (.34657359f + step * .06005663f);
        // the centre of half-resolution pixel x lies between pixels 2 x and 2 x + 1
        return KeyPoint(2 * (e.x + offset.x) + .5f, 2 * (e.y + offset.y) + .5f,
                (float)(4 * sigmas[e.scale]) * growth, -1, e.response, e.scale);
    }

private:
    static float within(float value, float limit) { return std::max(-limit, std::min(limit, value)); }

    //! Adds those of rows `first` to `last`.
    void find(int first, int last, std::vector<Extremum>& found) const
    {
        ScaleSpace space(normalized, steps, first, last);
        const DetectorKernels& kernels = detectorKernels();
        const size_t scales = sigmas.size();
        std::vector<int> columns(normalized.cols);
        for (int y = first; y <= last; y++)
        {
            space.advance(y);
            for (size_t s = 0; s < scales && y >= borders[s] && y < normalized.rows - borders[s]; s++)
            {
                const float* const bounds[] = {space.largest(s), space.largest(s ? s - 1 : s),
                        space.largest(s + 1 < scales ? s + 1 : s)};
                const int n = kernels.maxima(space.response(s, y), bounds, threshold, borders[s],
                        normalized.cols - borders[s], columns.data());
                for (int i = 0; i < n; i++)
                    if (!repeatsEarlier(space, s, y, columns[i]))
                        found.push_back(extremumAt(space, s, y, columns[i]));
            }
        }
    }

    //! Whether a neighbour that comes earlier has the same response.
    static bool repeatsEarlier(const ScaleSpace& space, size_t s, int y, int x)
    {
        const float *row = space.response(s, y), *above = space.response(s, y - 1);
        const float value = row[x];
        return row[x - 1] == value || above[x - 1] == value || above[x] == value || above[x + 1] == value ||
               (s > 0 && space.largest(s - 1)[x] == value);
    }

    Extremum extremumAt(const ScaleSpace& space, size_t s, int y, int x) const
    {
        Extremum e;
        for (int dy = -1; dy <= 1; dy++)
            std::copy_n(space.response(s, y + dy) + x - 1, 3, e.around[dy + 1]);
        e.response = e.around[1][1];
        e.scale = (int)s;
        e.y = y;
        e.x = x;
        const bool inside = s > 0 && s + 1 < sigmas.size();
        e.smaller = inside ? space.response(s - 1, y)[x] : e.response;
        e.larger = inside ? space.response(s + 1, y)[x] : e.response;
        return e;
    }

    const Mat& normalized;
    const float threshold;
    std::vector<double> sigmas;  //!< of each scale, in pixels of `normalized`
    std::vector<int> borders;    //!< pixels without keypoints on each side
    std::vector<SmoothingStep> steps;
};

}  // namespace

std::vector<KeyPoint> findBlobs(const Mat& normalized, const HessianParameters& parameters, const Mat& mask)
{
    const BlobFinder finder(normalized, parameters);
    const std::vector<std::vector<Extremum>> parts = finder.extrema();
    std::vector<const Extremum*> order;
    for (const std::vector<Extremum>& part : parts)
        for (const Extremum& e : part)
        {
            const Point2f pt = mask.empty() ? Point2f() : finder.refined(e).pt;
            if (mask.empty() || mask.at<uchar>(cvRound(pt.y), cvRound(pt.x)))
                order.push_back(&e);
        }
    // strongest first; of the same response by scale and place
    const auto before = [](const Extremum* a, const Extremum* b) {
        return std::tie(b->response, a->scale, a->y, a->x) < std::tie(a->response, b->scale, b->y, b->x);
    };
    const size_t most = parameters.maxFeatures, kept = most > 0 ? std::min(most, order.size()) : order.size();
    std::nth_element(order.begin(), order.begin() + kept, order.end(), before);
    order.resize(kept);
    std::sort(order.begin(), order.end(), before);
    std::vector<KeyPoint> keypoints;
    keypoints.reserve(order.size());
    for (const Extremum* e : order)
        keypoints.push_back(finder.refined(*e));
    return keypoints;
}

}  // namespace iib
}  // namespace cv
