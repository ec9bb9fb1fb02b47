// SPDX-License-Identifier: Apache-2.0
#include "opencv2/iib/alignment.hpp"
#include "opencv2/iib/detail/outputs.hpp"

#include "../common/points.hpp"
#include "../verdict/support.hpp"
#include "../views/view_search.hpp"
#include "judgement.hpp"

namespace cv::iib {
namespace {

const int FEATURES = 2000;        // of a view
const int MOST_IMPROVED = 3;      // rounds of improve()
const double MOST_TILT = 4;       // of the views that models with a shear are searched in
const double LEAST_REFINED = .5;  // of the matches that agree at the working size
const int FEW = 100;              // matches: blurred images may have MANY times as many at half the size
const int MANY = 3;

//! Pixels of the longer side at which upright images are matched, one after the other.
std::vector<int> workingSizes(const Size& first, const Size& second)
{
    if (std::max({first.width, first.height, second.width, second.height}) <= WORKING_SIZE / 2)
        return {WORKING_SIZE};
    return {WORKING_SIZE, WORKING_SIZE / 2};  // at half the size, blurred images (a focus stack) are sharper
}

//! The result of one pair of views, in the images' own pixels.
struct Answer
{
    Judgement judgement{"the images have too few matches", false, ""};
    Mat agreeing;       //!< as alignImages returns matches
    Matx33d transform;  //!< the best one, also where it is refused
    Mat error;
    int simplest = -1;  //!< AlignmentModel

    bool found() const { return judgement.against.empty(); }
};

//! The matches of one size, their transform, its errors and the verdict.
struct Alignment
{
    AlignedPoints points;
    Evidence evidence;
    std::vector<FittedTransform> all;
    size_t best;
    double beside;  //!< as deviationBeside() returns it
    Mat errors;     //!< working pixels
    Judgement judgement;

    /** @param coarse if not null: the alignment whose matches were refined at full size.
    @param pixel working pixels per pixel in which the matches were refined. */
    Alignment(const AlignedPoints& matched, const WorkingPair& pair, int model, int tried,
            const Alignment* coarse, double pixel)
        : points(matched), evidence{points, pair, tried, Verdict(points.image, points.reference)},
          all(coarse ? fittedTransforms(points, coarse->fitted()) : fittedTransforms(evidence, model)),
          best(model == ALIGN_AUTO ? simplestTrue(all, evidence) : 0),
          beside(coarse               ? coarse->beside
                  : fitted().exists() ? deviationBeside(fitted(), evidence)
                                      : 0)
    {
        if (fitted().exists())
            errors = cornerErrors(fitted(), points, pair.imageCorners(), beside, pixel);
        judgement = judge(all, best, evidence, errors);
        if (coarse && judgement.against.empty() && !coarse->judgement.note.empty())
            judgement.note = coarse->judgement.note;  // only the matches of the transform were refined
        if (judgement.against.empty() && tried > 1 &&
                areOneStructure(marked(points, fitted().agree).reference))
            judgement = {
                    "the images share one structure that looks the same in some view, such as a round spot",
                    false, ""};
    }

    Alignment(const Alignment&) = delete;

    const FittedTransform& fitted() const { return all[best]; }

    Answer inPixels(int model) const
    {
        const WorkingPair& pair = evidence.pair;
        Answer answer = {judgement, pair.inPixels(points, fitted().agree), Matx33d(), Mat()};
        if (fitted().exists())
            answer.transform = pair.inPixels(fitted().transform());
        if (!answer.found())
            return answer;
        answer.error = Mat(errors * pair.inPixels(1));
        answer.simplest = model == ALIGN_AUTO ? fitted().model : simplestModel(fitted(), points);
        if (answer.simplest < fitted().model && answer.judgement.note.empty())
            answer.judgement.note =
                    format("a transform of less freedom explains the matches as well, and is more exact: %s",
                            nameOf(answer.simplest));
        return answer;
    }
};

Answer answerOf(const WorkingPair& pair, int model, int tried)
{
    const Alignment first(pair.match(), pair, model, tried, nullptr, 1);
    if (!first.judgement.against.empty() || !pair.isReduced())
        return first.inPixels(model);
    const FittedTransform& fitted = first.fitted();
    const Alignment again(pair.refined(first.points, fitted.agree, fitted.transform()), pair, model, tried,
            &first, 1 / pair.inPixels(1));
    // Images that are blurred, or sharp in one part alone, refine too few matches at full size.
    const bool isFiner = again.fitted().count() > LEAST_REFINED * fitted.count() && again.judgement.isLast;
    return (isFiner ? again : first).inPixels(model);
}

class ImageAlignerImpl : public ImageAligner
{
public:
    ImageAlignerImpl(const Mat& reference, int model, const Mat& mask)
        : model_(model), reference_(reference, mask, FEATURES)
    {
    }

    bool align(InputArray image, OutputArray transform, OutputArray error, OutputArray matches,
            String* reason, InputArray mask, int* simplest, String* note) const override
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
        if (simplest)
            *simplest = best.simplest;
        if (note)
            *note = best.judgement.note;
        clear(transform);
        clear(error);
        if (!best.found())
            return false;
        Mat(best.transform).copyTo(transform);
        if (error.needed())
            best.error.copyTo(error);
        return true;
    }

private:
    /** Keeps the best answer of all working sizes, up to the size that decides. An answer with fewer matches than a refused one, such as a
    logo's, does not count. A transform of few matches does not decide alone, and gives way to MANY times as many. */
    template <typename PairOf>
    void attempt(PairOf pairOf, const ImageViews& second, int tried, Answer& best) const
    {
        for (int size : workingSizes(reference_.size(), second.size()))
        {
            const Answer answer = answerOf(pairOf(size), model_, tried);
            const bool refuses = answer.judgement.isLast && !answer.found() && !best.found();
            const int least = best.found() ? MANY * best.agreeing.rows : best.agreeing.rows;
            if (refuses || best.agreeing.empty() || answer.agreeing.rows > least)
                best = answer;
            if (best.judgement.isLast && (!best.found() || best.agreeing.rows >= FEW))
                return;
        }
    }

    //! Searches for views in which rotated, zoomed or tilted images look alike.
    void search(const ImageViews& second, Answer& best) const
    {
        if (best.judgement.isLast)
            improve(second, Matx33d::eye(), false, 1, best);
        const bool areOfOneSize = !isMuchLarger(reference_, second);
        if (best.judgement.isLast && (best.found() || areOfOneSize))
            return;
        const Answer ofWhole = best;
        if (!areOfOneSize)
            best = Answer();  // the reference's other parts do not count
        const bool onlySimilar = model_ == ALIGN_SIMILARITY;
        searchViews(reference_, second, onlySimilar ? 1 : MOST_TILT,
                [&](const ViewCandidate& candidate, int tried) {
                    const Matx33d map = onlySimilar ? similarityOf(candidate.map) : candidate.map;
                    attempt([&](int size) { return WorkingPair(reference_, second, size, map); }, second,
                            tried, best);
                    if (best.judgement.isLast)
                        improve(second, map, true, tried, best);
                    return best.judgement.isLast;
                });
        if (best.agreeing.empty())
            best = ofWhole;
    }

    /** Matches again in the views of the transform that was found, while they differ from the last ones. This includes a refusal: in views that
    fit badly, matches may lie as if the camera had moved. A transform that is refused in its own views is of another place, such as a similar
    window: the search goes on.
    @param areParts whether only the parts were matched that both images show. */
    void improve(const ImageViews& second, Matx33d map, bool areParts, int tried, Answer& best) const
    {
        for (int round = 0; round < MOST_IMPROVED && !best.agreeing.empty(); round++)
        {
            const Scalar centre = mean(best.agreeing.reshape(4));
            const Matx33d next = affineAt(best.transform.inv(), Point2d(centre[0], centre[1]));
            const bool arePlaced =
                    areParts ? showSameParts(next, map, second.size()) : !isMuchLarger(reference_, second);
            if (haveSimilarViews(next, map) && arePlaced)
                return;
            map = next;
            areParts = true;
            Answer answer = answerOf(WorkingPair(reference_, second, WORKING_SIZE, map), model_, tried + 1);
            if (best.found() && !answer.found())
                answer.judgement.against =
                        "in views that look alike under the best transform, " + answer.judgement.against;
            else if (answer.agreeing.rows <= best.agreeing.rows)
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
    if (model < ALIGN_TRANSLATION || model > ALIGN_AUTO)
        CV_Error(Error::StsBadArg,
                format("alignImages: model is %d; it must be ALIGN_TRANSLATION, ALIGN_SIMILARITY, "
                       "ALIGN_AFFINE, ALIGN_HOMOGRAPHY or ALIGN_AUTO",
                        model));
    return makePtr<ImageAlignerImpl>(reference.getMat(), model, mask.getMat());
}

bool alignImages(InputArray reference, InputArray image, OutputArray transform, int model, OutputArray error,
        OutputArray matches, String* reason, InputArray referenceMask, InputArray mask, int* simplest,
        String* note)
{
    return ImageAligner::create(reference, model, referenceMask)
            ->align(image, transform, error, matches, reason, mask, simplest, note);
}

}  // namespace cv::iib
