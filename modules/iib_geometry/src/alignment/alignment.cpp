// SPDX-License-Identifier: Apache-2.0
#include "opencv2/iib/alignment.hpp"

#include "../verdict/parallax.hpp"
#include "../pose/planar_problem.hpp"
#include "../common/points.hpp"
#include "spread.hpp"
#include "../pose/uncertainty.hpp"
#include "../verdict/verdict.hpp"
#include "../verdict/support.hpp"
#include "../views/view_search.hpp"
#include "working_pair.hpp"

namespace cv::iib {
namespace {

const double LEAST_SCALE = .25;   // by which matches count as agreeing, working pixels
const double LEAST_SPREAD = .12;  // of what has points, that the agreeing matches span: a logo spans less
const double LEAST_WHOLE = .05;   // of what both images have, whether it has points or not
/* Of the cells that matches of any points would be in, those that agreeing ones are in. Captions and logos at two ends of a picture
have .2 at most, pairs under other light .41 at least. */
const double LEAST_SCATTER = .33;
/* By which a model that is true is better than one that is not, as logarithms of likelihoods, for each number that it has more, and for each
match. Noise and bent lenses have up to 3.9 of numbers, or .23 of matches; untrue models that are told as surer than they are 5.3 and .29
(103 pairs under other light, moved by transforms of each kind). */
const double LEAST_GAIN = 4.5, LEAST_GAIN_OF_MATCH = .25;
const double MOST_PARALLAX = .25;  // of the places that agree may move as if the camera had moved
const double LEAST_PARALLAX = 6;   // working pixels: shadows of another light move by less
const int WORKING_SIZE = 1024;     // as HessianDetector has it
const int FEATURES = 2000;         // of a view
const int MOST_IMPROVED = 3;       // times
const double MOST_TILT = 4;        // that models with a shear are searched for
const double ANY = 1e3;            // deviation of a number of a transform

const double LEAST_REFINED = .5;  // of the matches that agree at the working size
/* Of a match's deviation: what light and lens shift in all matches alike, as far as pairs under other lamps and exposures show it
(doc/uncertainty.md). */
const double COMMON = .4;

const char* const MODELS[] = {"TRANSLATION", "SIMILARITY", "AFFINE", "HOMOGRAPHY"};
const char* const NAMES[] = {"a translation", "a similarity", "an affine transform", "a homography"};

int countOf(const Verdict::Marks& marks) { return (int)std::count(marks.begin(), marks.end(), true); }

//! A transform of two images' matches, in working pixels, and how they lie around it.
struct Aligned
{
    PlanarProblem problem;
    Fit<PlanarProblem> fit;
    Verdict::Marks agree;
    double limit;  //!< of those that agree

    Aligned(const AlignedPoints& points, int model)
        : problem(points.reference, points.image, model), fit(robustFit(problem, 0)),
          limit(3 * std::max(fit.scale, LEAST_SCALE))
    {
        agree = within(limit, fit.squared);
        agree.resize(problem.size());
    }

    int count() const { return countOf(agree); }
};

//! @param tried number of views in which the images were matched.
bool isCertain(const Aligned& aligned, const Verdict& verdict, int tried)
{
    std::vector<double> limits;
    for (double limit : {.5, 1., 2., 4.})
        limits.push_back(limit * aligned.limit);
    const auto errorOf = [&](int i, int j) { return aligned.problem.squaredError(aligned.fit.model, i, j); };
    return verdict.logFalseAlarms(aligned.fit.squared, errorsOfWrongMatches(verdict, errorOf),
                   Verdict::FROM_POINT, aligned.problem.sampleSize(), limits) +
                   std::log10((double)tried) <
           Verdict::CERTAIN;
}

/** Standard deviations of the places of the image's corners, 4 x 1, CV_64F, working pixels.
@param beside what parts of the images differ by from the transform. */
Mat deviationsOf(const Aligned& aligned, const AlignedPoints& points, const std::vector<Point2d>& corners,
        double beside)
{
    const Square<PlanarProblem::Step> covariance =
            covarianceOf(aligned.problem, aligned.fit, partsOf(points.reference), ANY);
    Mat deviations(4, 1, CV_64F);
    for (int k = 0; k < 4; k++)
        deviations.at<double>(k) =
                std::hypot(aligned.problem.deviation(aligned.fit.model, covariance, corners[k]),
                        std::hypot(std::sqrt(2) * COMMON * aligned.fit.scale, beside));
    return deviations;
}

//! Pixels of the longer side at which upright images are matched, one after the other.
std::vector<int> workingSizes(const Size& first, const Size& second)
{
    if (std::max({first.width, first.height, second.width, second.height}) <= WORKING_SIZE / 2)
        return {WORKING_SIZE};
    return {WORKING_SIZE,
            WORKING_SIZE / 2};  // blurred images, as of a focus stack, are sharper at half the size
}

//! The matches beside a transform by so much, working pixels, or more, that the camera's motion explains.
Verdict::Marks movedBeside(
        const Aligned& aligned, const AlignedPoints& points, double distance, const Verdict& verdict)
{
    return movedByParallax(points.reference, points.image, aligned.problem.inPixels(aligned.fit.model),
            within(std::max(2 * aligned.limit, distance), aligned.fit.squared), aligned.limit, verdict);
}

/** By how much a part of the images is beside the transform, as by light that moves shadows or by a camera that moved little, working
pixels; 0 if it is no larger than what makes no parallax. */
double deviationBeside(const Aligned& aligned, const AlignedPoints& points)
{
    const Verdict verdict(points.image, points.reference);
    const Verdict::Marks moved = movedBeside(aligned, points, 0, verdict);
    if (verdict.places(moved) <= MOST_PARALLAX * verdict.places(aligned.agree))
        return 0;
    double sum = 0;
    for (size_t i = 0; i < moved.size(); i++)
        sum += moved[i] ? aligned.fit.squared[i] : 0;
    return std::sqrt(sum / std::max(countOf(moved), 1));
}

/** Whether a model of more freedom explains the matches better than noise would let it: by the likelihood of the errors, as Cauchy's loss
under the scale of the richer model has it. */
bool isBetter(const Aligned& richer, const Aligned& aligned)
{
    const auto loss = [&](const Aligned& a) {
        return a.problem.loss(a.fit.model, Loss{richer.limit / 3}, std::numeric_limits<double>::max());
    };
    if (richer.fit.squared.empty())
        return false;
    const double gain = loss(aligned) - loss(richer);
    return gain > LEAST_GAIN * (richer.problem.parameters() - aligned.problem.parameters()) &&
           gain > LEAST_GAIN_OF_MATCH * richer.count();
}

struct Judgement
{
    std::string against;  //!< why the images have no such transform; empty if they have
    bool isLast;          //!< whether another attempt can say nothing else
};

/** Why another model is that of the images; empty if this one is, or if the answer is doubtful.
@param richer the transforms of more freedom, the one of most freedom last. */
std::string reasonAgainstModel(
        const Aligned& aligned, const std::vector<Aligned>& richer, const Verdict& verdict, int tried)
{
    const size_t model = ALIGN_HOMOGRAPHY - richer.size();
    if (richer.empty() || !isBetter(richer.back(), aligned) || !isCertain(richer.back(), verdict, tried))
        return "";
    size_t k = 0;
    while (isBetter(richer.back(), richer[k]))
        k++;
    const auto near = [&](const Aligned& a) { return countOf(within(richer[k].limit, a.fit.squared)); };
    return format("the images differ by more than %s: %s agrees with %d matches in place of %d, and "
                  "better",
            NAMES[model], MODELS[model + 1 + k], near(richer[k]), near(aligned));
}

Judgement judge(
        const Aligned& aligned, const AlignedPoints& points, int model, const WorkingPair& pair, int tried)
{
    if (aligned.fit.squared.empty())
        return {"the images have too few matches", false};
    const Verdict verdict(points.image, points.reference);  // errors are in the reference
    std::vector<Aligned> richer;
    for (int other = model + 1; other <= ALIGN_HOMOGRAPHY; other++)
        richer.emplace_back(points, other);
    const std::string wrongModel = reasonAgainstModel(aligned, richer, verdict, tried);
    if (!wrongModel.empty())
        return {wrongModel, true};
    if (!isCertain(aligned, verdict, tried))
        return {format("the transform that agrees best has %d of %d matches, no more than chance may give: "
                       "the images may not show the same",
                        aligned.count(), aligned.problem.size()),
                false};
    const Aligned& richest = richer.empty() || richer.back().fit.squared.empty() ? aligned : richer.back();
    const Verdict::Marks moved = movedBeside(richest, points, LEAST_PARALLAX, verdict);
    if (verdict.places(moved) > MOST_PARALLAX * verdict.places(richest.agree))
        return {format("%d matches agree with one transform, and %d more are beside it along lines through "
                       "one point: the camera moved through a scene that is not flat (parallax; "
                       "findRelativePose is for such images), or a part of what it sees moved one way, as "
                       "shadows do",
                        richest.count(), countOf(moved)),
                true};
    const Spread spread(points, aligned.agree, aligned.problem.inPixels(aligned.fit.model), pair,
            aligned.problem.sampleSize());
    if (spread.area < LEAST_SPREAD || spread.whole < LEAST_WHOLE)
        return {format("the images share %.0f %% of what both could show and nothing else: a logo, a "
                       "caption?",
                        100 * std::min(spread.area, spread.whole)),
                false};
    if (spread.scatter < LEAST_SCATTER)
        return {format("the images share a few small parts, with %d matches, and nothing between these: "
                       "logos, captions?",
                        aligned.count()),
                false};
    return {"", true};
}

//! What images matched in one pair of views tell, in the images' own pixels.
struct Answer
{
    Judgement judgement;
    Mat agreeing;       //!< as alignImages returns matches
    Matx33d transform;  //!< that most of them agree with, also where it is refused
    Mat error;

    bool found() const { return judgement.against.empty(); }
};

std::vector<Point2d> agreeing(const Mat& points, const Verdict::Marks& agree)
{
    std::vector<Point2d> chosen;
    for (int i = 0; i < points.rows; i++)
        if (agree[i])
            chosen.push_back(points.at<Point2d>(i));
    return chosen;
}

Answer answerOf(const WorkingPair& pair, int model, int tried)
{
    AlignedPoints points = pair.match();
    Aligned aligned(points, model);
    Answer answer;
    answer.judgement = judge(aligned, points, model, pair, tried);
    if (answer.found() && tried > 1 && areOneStructure(agreeing(points.reference, aligned.agree)))
        answer.judgement = {
                "the images share one structure that looks the same in some view, such as a round spot",
                false};
    const double beside =
            answer.found() ? deviationBeside(aligned, points) : 0;  // only those that agree are refined
    if (answer.found() && pair.isReduced())
    {
        const AlignedPoints fine =
                pair.refined(points, aligned.agree, aligned.problem.inPixels(aligned.fit.model));
        const Aligned again(fine, model);
        // Else they are too blurred, or sharp in a part alone.
        if (again.count() > LEAST_REFINED * aligned.count())
        {
            const Judgement finer = judge(again, fine, model, pair, tried);
            if (finer.isLast)
            {
                answer.judgement = finer;
                aligned = again;
                points = fine;
            }
        }
    }
    answer.agreeing = pair.inPixels(points, aligned.agree);
    if (aligned.fit.squared.empty())
        return answer;
    answer.transform = pair.inPixels(aligned.problem.inPixels(aligned.fit.model));
    if (answer.found())
        answer.error = Mat(deviationsOf(aligned, points, pair.imageCorners(), beside) * pair.inPixels(1));
    return answer;
}

class ImageAlignerImpl : public ImageAligner
{
public:
    ImageAlignerImpl(const Mat& reference, int model, const Mat& mask)
        : model_(model), reference_(reference, mask, FEATURES)
    {
    }

    bool align(InputArray image, OutputArray transform, OutputArray error, OutputArray matches,
            String* reason, InputArray mask) const override
    {
        const ImageViews second(image.getMat(), mask.getMat(), FEATURES);
        Answer best;
        attempt([&](int size) { return WorkingPair(reference_, second, size, model_ == ALIGN_TRANSLATION); },
                second, 1, best);
        if (model_ != ALIGN_TRANSLATION)
            search(second, best);
        writeRows(best.agreeing, matches);
        if (reason)
            *reason = best.judgement.against;
        if (best.found())
        {
            Mat(best.transform).copyTo(transform);
            if (error.needed())
                best.error.copyTo(error);
            return true;
        }
        clear(transform);
        clear(error);
        return false;
    }

private:
    /** Keeps the best answer at all working sizes, up to the last one that is needed. What fewer matches agree with than with one that
    was refused, such as that of a logo, is none. */
    template <typename PairOf>
    void attempt(PairOf pairOf, const ImageViews& second, int tried, Answer& best) const
    {
        for (int size : workingSizes(reference_.size(), second.size()))
        {
            const Answer answer = answerOf(pairOf(size), model_, tried);
            if ((answer.judgement.isLast && !answer.found()) || best.agreeing.empty() ||
                    answer.agreeing.rows > best.agreeing.rows)
                best = answer;
            if (best.judgement.isLast)
                return;
        }
    }

    //! In views that images rotated, zoomed or tilted against each other are alike in, if they are.
    void search(const ImageViews& second, Answer& best) const
    {
        if (best.judgement.isLast)
            return improve(second, Matx33d::eye(), 1, best);
        const bool onlySimilar = model_ == ALIGN_SIMILARITY;
        searchViews(reference_, second, onlySimilar ? 1 : MOST_TILT,
                [&](const ViewCandidate& candidate, int tried) {
                    const Matx33d map = onlySimilar ? similarityOf(candidate.map) : candidate.map;
                    if (areAlike(map, Matx33d::eye()))
                        return false;  // it was tried
                    attempt([&](int size) { return WorkingPair(reference_, second, size, map); }, second,
                            tried, best);
                    if (best.judgement.isLast)
                        improve(second, map, tried, best);
                    return best.judgement.isLast;
                });
    }

    /** Again in the views of the transform that was found, as long as these are others. Where the answer was a refusal, too: matches in views that
    fit badly may lie as if the camera had moved. */
    void improve(const ImageViews& second, Matx33d map, int tried, Answer& best) const
    {
        for (int round = 0; round < MOST_IMPROVED; round++)
        {
            const Matx33d next = affineAt(best.transform.inv(), Point2d(reference_.size()) / 2);
            if (areAlike(next, map))
                return;
            map = next;
            const Answer answer =
                    answerOf(WorkingPair(reference_, second, WORKING_SIZE, map), model_, tried + 1);
            if (answer.agreeing.rows <= best.agreeing.rows || (best.found() && !answer.found()))
                return;
            best = answer;
        }
    }

    int model_;
    ImageViews reference_;
};

}  // namespace

Ptr<ImageAligner> ImageAligner::create(InputArray reference, int model, InputArray mask)
{
    if (model < ALIGN_TRANSLATION || model > ALIGN_HOMOGRAPHY)
        CV_Error(Error::StsBadArg,
                format("alignImages: model is %d; it must be ALIGN_TRANSLATION, ALIGN_SIMILARITY, "
                       "ALIGN_AFFINE or ALIGN_HOMOGRAPHY",
                        model));
    return makePtr<ImageAlignerImpl>(reference.getMat(), model, mask.getMat());
}

bool alignImages(InputArray reference, InputArray image, OutputArray transform, int model, OutputArray error,
        OutputArray matches, String* reason, InputArray referenceMask, InputArray mask)
{
    return ImageAligner::create(reference, model, referenceMask)
            ->align(image, transform, error, matches, reason, mask);
}

}  // namespace cv::iib
