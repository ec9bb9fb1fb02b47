// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DEMO_PICTURE_HPP
#define OPENCV_IIB_DEMO_PICTURE_HPP

#include "iib_demo_pipeline.hpp"

#include "opencv2/imgproc.hpp"

static const int HALF_WIDTH = 640;     // of the picture, pixels
static const int MAX_DRAWN = 100;      // matches: more would hide the images
static const int CAPTION_HEIGHT = 44;  // pixels
// The pair of colours is distinct for colour-blind eyes too.
static const cv::Scalar GOOD(150, 220, 60), OTHER(40, 90, 255), PAPER(32, 28, 26), INK(235, 235, 235);

inline int writeText(cv::Mat& canvas, const std::string& text, cv::Point at, const cv::Scalar& color)
{
    const double size = 0.68;
    cv::putText(canvas, text, at, cv::FONT_HERSHEY_DUPLEX, size, color, 1, cv::LINE_AA);
    return at.x + cv::getTextSize(text, cv::FONT_HERSHEY_DUPLEX, size, 1, 0).width;
}

inline void drawCaption(cv::Mat& canvas, const Result& result, bool homographyGiven)
{
    const int good = result.goodCount(), others = (int)result.matches.size() - good, y = CAPTION_HEIGHT - 15;
    int x = writeText(canvas, result.name + ":  ", cv::Point(14, y), INK);
    if (!result.judged)
    {
        writeText(canvas, cv::format("%d matches, no homography found", others), cv::Point(x, y), OTHER);
        return;
    }
    x = writeText(canvas, cv::format(homographyGiven ? "%d correct" : "%d consistent", good), cv::Point(x, y),
            GOOD);
    x = writeText(canvas, cv::format(homographyGiven ? "  %d wrong" : "  %d others", others), cv::Point(x, y),
            OTHER);
    writeText(canvas, cv::format("  %.0f %%", 100 * result.precision()), cv::Point(x, y), INK);
}

//! Both images side by side under a caption, a line for each match; good ones lie above the others.
inline cv::Mat drawResult(const Pair& pair, const Result& result, bool homographyGiven)
{
    cv::Mat halves[2];
    double scale[2];
    int height = 0;
    for (int i = 0; i < 2; i++)
    {
        scale[i] = (double)HALF_WIDTH / pair.images[i].cols;
        cv::resize(pair.images[i], halves[i], cv::Size(HALF_WIDTH, cvRound(pair.images[i].rows * scale[i])),
                0, 0, cv::INTER_AREA);
        height = std::max(height, halves[i].rows);
    }
    cv::Mat canvas(CAPTION_HEIGHT + height, 2 * HALF_WIDTH, CV_8UC3, PAPER);
    for (int i = 0; i < 2; i++)
        halves[i].copyTo(canvas(cv::Rect(cv::Point(i * HALF_WIDTH, CAPTION_HEIGHT), halves[i].size())));

    // Keypoints come strongest first: matches at equal steps are a fair choice.
    const double step = std::max(1., (double)result.matches.size() / MAX_DRAWN);
    for (int good = 0; good < 2; good++)
    {
        cv::Mat lines = canvas.clone();
        const cv::Scalar color = good ? GOOD : OTHER;
        for (double at = 0; at < (double)result.matches.size(); at += step)
        {
            const size_t m = (size_t)at;
            if ((result.good[m] != 0) != (good != 0))
                continue;
            const cv::Point2f a = result.keypoints[0][result.matches[m].queryIdx].pt * (float)scale[0];
            const cv::Point2f b = result.keypoints[1][result.matches[m].trainIdx].pt * (float)scale[1];
            const cv::Point from(cvRound(a.x), cvRound(a.y) + CAPTION_HEIGHT);
            const cv::Point to(cvRound(b.x) + HALF_WIDTH, cvRound(b.y) + CAPTION_HEIGHT);
            cv::line(lines, from, to, color, 1, cv::LINE_AA);
            cv::circle(canvas, from, 2, color, cv::FILLED, cv::LINE_AA);
            cv::circle(canvas, to, 2, color, cv::FILLED, cv::LINE_AA);
        }
        // Transparent, so that the images are seen.
        const double opacity = good ? 0.8 : 0.6;
        cv::addWeighted(lines, opacity, canvas, 1 - opacity, 0, canvas);
    }
    drawCaption(canvas, result, homographyGiven);
    return canvas;
}

#endif
