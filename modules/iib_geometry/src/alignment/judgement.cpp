// SPDX-License-Identifier: Apache-2.0
#include "judgement.hpp"

#include "opencv2/iib/alignment.hpp"
#include "../verdict/pose_tests.hpp"

namespace cv::iib {
namespace {

const double MOST_PARALLAX = .25;  // of the places that agree may move as if the camera had moved
const double LEAST_PARALLAX = 6;   // working pixels; shadows move by less
const double LEAST_BESIDE = .125;  // of the places that agree: a part whose displacement is an error
const double MOST_ERROR = .25;     // of the image's diagonal
const double LEAST_TOGETHER = .6;  // of the matches of a part that moves as one
const double LEAST_OVERLAP = .3;   // of an image's area
const double MOST_CLIPPED = .5;    // of an image's pixels are black or white

const char* const NAMES[] = {"a translation", "a similarity", "an affine transform", "a homography"};

struct Parts
{
    SharedPart reference, image;
    Spread spread;

    Parts(const FittedTransform& fitted, const Evidence& evidence)
        : reference(evidence.pair.sharedPart(0, evidence.points, fitted.agree, fitted.transform())),
          image(evidence.pair.sharedPart(1, evidence.points, fitted.agree, fitted.transform())),
          spread(reference, image, fitted.problem.sampleSize())
    {
    }
};

/** The matches beside a transform by a distance, working pixels, or more, that the camera's motion explains. Where the transform has matches,
too, the others are wrong: a letter that repeats is no camera's motion.
@param least places, as a share of those that agree; none are returned if they have no more. */
Verdict::Marks partsBeside(
        const FittedTransform& fitted, const Evidence& evidence, double distance, double least)
{
    const AlignedPoints& points = evidence.points;
    const Verdict& verdict = evidence.verdict;
    const Verdict::Marks explained = within(std::max(2 * fitted.limit, distance), fitted.fit.squared);
    Verdict::Marks moved = explained;
    moved.flip();
    for (bool byCamera : {false, true})
    {
        if (byCamera)
            moved = movedByParallax(
                    points.reference, points.image, fitted.transform(), explained, fitted.limit, verdict);
        moved = verdict.elsewhere(moved, fitted.agree);
        if (verdict.places(moved) <= least * verdict.places(fitted.agree))
            return {};
    }
    return moved;
}

//! Whether the richer transform belongs to another part of the images, and the simple one to a place of its own.
bool isElsewhere(const FittedTransform& richer, const FittedTransform& simple, const Evidence& evidence)
{
    return isOfAnotherPart(richer, simple) && simple.isSignificant(evidence) &&
           Parts(simple, evidence).spread.isPlace(simple.count());
}

std::string reasonAgainstModel(
        const std::vector<FittedTransform>& all, size_t judged, const Evidence& evidence)
{
    if (!isBetter(all.back(), all[judged]) || !all.back().isSignificant(evidence) ||
            isElsewhere(all.back(), all[judged], evidence))
        return "";
    size_t k = judged + 1;
    while (isBetter(all.back(), all[k]))
        k++;
    const auto near = [&](const FittedTransform& f) { return countOf(within(all[k].limit, f.fit.squared)); };
    return format("the images differ by more than %s: %s agrees with %d matches in place of %d, and "
                  "better",
            NAMES[all[judged].model], nameOf(all[k].model), near(all[k]), near(all[judged]));
}

//! Share of the pixels without detail, since the exposure was too short or too long.
double clippedShare(const Mat& image)
{
    if (image.empty() || image.depth() != CV_8U)  // of other depths the largest value is not known
        return 0;
    Mat exposed;
    inRange(image.reshape(1), 5, 250, exposed);
    return 1 - countNonZero(exposed) / (double)exposed.total();
}

//! Why there are too few matches: an image's exposure, or else the given reason.
Judgement refusedByFew(const WorkingPair& pair, std::string reason)
{
    for (int which : {0, 1})
        if (const double clipped = clippedShare(pair.pixels(which)); clipped > MOST_CLIPPED)
            reason = format(
                    "%.0f %% of the %s is black or white, and too few matches agree elsewhere: align it "
                    "through exposures between the two",
                    100 * clipped, which ? "image" : "reference");
    return {reason, false, ""};
}

//! Whether most matches agree with one similarity: a part that moved or a second plane, not a scene with depth.
bool isOneMotion(const Verdict::Marks& moved, const Evidence& evidence)
{
    const int count = countOf(moved), trials = 150;  // enough for a similarity that most matches agree with
    return count > 0 && FittedTransform(marked(evidence.points, moved), ALIGN_SIMILARITY, trials).count() >
                                LEAST_TOGETHER * count;
}

//! Matches beside the transform: the camera moved, or a part of the scene did.
void judgeMotion(const FittedTransform& fitted, const Evidence& evidence, Judgement& judgement)
{
    const Verdict::Marks moved = partsBeside(fitted, evidence, LEAST_PARALLAX, MOST_PARALLAX);
    if (moved.empty())
        return;
    if (isOneMotion(moved, evidence))
        judgement.note = format(
                "%d matches of another part agree with each other and lie beside the transform: that part "
                "moved otherwise, or is nearer or farther",
                countOf(moved));
    else
        judgement.against = format(
                "%d matches agree with one transform, and %d more are beside it along lines through one "
                "point: the camera moved through a scene that is not flat (parallax; findRelativePose is for "
                "such images), or a pattern repeats",
                fitted.count(), countOf(moved));
}

}  // namespace

size_t simplestTrue(const std::vector<FittedTransform>& all, const Evidence& evidence)
{
    const double scale = 8 * REFINED;  // of a richer model's fit to the matches of a simple one
    size_t best = 0;
    const auto isOfItsOwnPart = [&](const FittedTransform& simple, const FittedTransform& richer) {
        return isElsewhere(richer, simple, evidence) &&
               !isBetter({evidence.points, richer.model, simple.transform(), scale}, simple);
    };
    for (size_t k = 1; k < all.size(); k++)
        if (!all[best].exists() ||
                (gainOf(all[k], all[best]) > NEEDED_GAIN && !isOfItsOwnPart(all[best], all[k])))
            best = k;
    return best;
}

Judgement judge(
        const std::vector<FittedTransform>& all, size_t judged, const Evidence& evidence, const Mat& errors)
{
    const FittedTransform& fitted = all[judged];
    const auto refused = [](const std::string& why) { return Judgement{why, false, ""}; };
    if (!fitted.exists())
        return refusedByFew(evidence.pair, "the images have too few matches");
    Judgement judgement = {reasonAgainstModel(all, judged, evidence), true, ""};
    if (!judgement.against.empty())
        return judgement;
    if (!fitted.isSignificant(evidence))
        return refusedByFew(
                evidence.pair, format("the best transform agrees with %d of %d matches, which could "
                                      "be random: the images may not show the same scene",
                                       fitted.count(), fitted.problem.size()));
    const FittedTransform& richest =
            all.back().exists() && !isOfAnotherPart(all.back(), fitted) ? all.back() : fitted;
    judgeMotion(richest, evidence, judgement);
    if (!judgement.against.empty())
        return judgement;
    if (areOfTheSensor(fitted, evidence))
        return {"the matches are single pixels that do not move, while larger points moved: hot pixels or "
                "dust of the camera; mask or correct them",
                true, ""};
    const Parts parts(fitted, evidence);
    if (isOverlay(parts.reference, parts.image))
        return refused(
                "the images are equal to the pixel in some parts and differ in the others: a logo, a caption "
                "or a frame lies over both, or a part of the vehicle shows; mask it");
    const Spread& spread = parts.spread;
    const bool isSmall = !spread.isPlace(fitted.count()) && !spread.isEverywhere(),
               isUncertain = !(norm(errors, NORM_INF) < MOST_ERROR * evidence.pair.imageDiagonal());
    const double overlap = std::max(parts.reference.share, parts.image.share);
    if ((isSmall || isUncertain) && overlap < LEAST_OVERLAP)
        return refused(format("the images overlap by only %.0f %%, and the %d matches there do not determine "
                              "a transform: use images that overlap more",
                100 * overlap, fitted.count()));
    if (isSmall)
        return refused(format("the images agree only in small parts, with %d matches over %.0f %% of an "
                              "image: too little to distinguish a place from a logo or a caption",
                fitted.count(), 100 * std::min(spread.area, spread.whole)));
    if (isUncertain)
        return refused(
                format("%d matches agree, but they leave the image's corners uncertain by a quarter of "
                       "its size",
                        fitted.count()));
    if (!spread.isEverywhere() && judgement.note.empty())
        judgement.note = format("the images agree in one part of %.0f %% of the overlap; elsewhere the "
                                "transform is extrapolated",
                100 * std::min(spread.area, 1.));
    return judgement;
}

double deviationBeside(const FittedTransform& fitted, const Evidence& evidence)
{
    const Verdict& verdict = evidence.verdict;
    Verdict::Marks moved = partsBeside(fitted, evidence, 0, LEAST_BESIDE), far = moved;
    if (moved.empty())
        return 0;
    for (size_t i = 0; i < moved.size(); i++)
        far[i] = moved[i] && fitted.fit.squared[i] >= square(LEAST_PARALLAX);
    const bool isMotion = isOneMotion(far, evidence);  // the note of judgeMotion speaks of it
    std::vector<double> squares;
    for (size_t i = 0; i < moved.size(); i++)
    {
        moved[i] = moved[i] && !(isMotion && far[i]);
        if (moved[i])
            squares.push_back(fitted.fit.squared[i]);
    }
    if (verdict.places(moved) <= LEAST_BESIDE * verdict.places(fitted.agree))
        return 0;
    const auto most = squares.begin() + squares.size() * 2 / 3;  // wrong matches are farther
    std::nth_element(squares.begin(), most, squares.end());
    return std::sqrt(*most);
}

}  // namespace cv::iib
