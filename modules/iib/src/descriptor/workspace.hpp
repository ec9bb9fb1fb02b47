// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_WORKSPACE_HPP
#define OPENCV_IIB_DESCRIPTOR_WORKSPACE_HPP

#include <memory>

#include "bit_encoder.hpp"

namespace cv {
namespace iib {

//! Memory that one thread uses again for each batch of keypoints. What it holds means nothing between two batches.
struct Workspace
{
    static constexpr int MAX_PACKS = 1 + (MAX_EXTRA_CHANNELS + GROUP_CHANNELS - 1) / GROUP_CHANNELS;

    ScratchMemory channelRows, ring;
    ScratchMemory sourceRows[MAX_PACKS], sourcePixels[MAX_PACKS], sparsePixels,
            planes;  //!< of rotated regions
    CellGrid<ushort> shortCells;
    CellGrid<unsigned> cells, parentCells;
    CellGrid<double> doubleCells;
    CellGrid<ushort>& cellsOf(ushort) { return shortCells; }
    CellGrid<unsigned>& cellsOf(unsigned) { return cells; }
    CellGrid<double>& cellsOf(double) { return doubleCells; }
    BitEncoder::Workspace encoder;
    ScratchMemory boxMeans;
    BoxPlaces boxPlaces;
};

//! The workspaces of a call; threads borrow them.
class WorkspacePool
{
public:
    std::unique_ptr<Workspace> borrow()
    {
        AutoLock lock(mutex);
        if (spare.empty())
            return std::unique_ptr<Workspace>(new Workspace);
        std::unique_ptr<Workspace> workspace = std::move(spare.back());
        spare.pop_back();
        return workspace;
    }

    void giveBack(std::unique_ptr<Workspace> workspace)
    {
        AutoLock lock(mutex);
        spare.push_back(std::move(workspace));
    }

private:
    Mutex mutex;
    std::vector<std::unique_ptr<Workspace>> spare;
};

//! Calls work(job, workspace) for a range of jobs.
template <typename Work> class Jobs CV_FINAL : public ParallelLoopBody
{
public:
    Jobs(const Work& work_, WorkspacePool& pool_) : work(work_), pool(pool_) {}

    void operator()(const Range& range) const CV_OVERRIDE
    {
        std::unique_ptr<Workspace> workspace = pool.borrow();
        for (int job = range.start; job < range.end; job++)
            work(job, *workspace);
        pool.giveBack(std::move(workspace));
    }

private:
    const Work& work;
    WorkspacePool& pool;
};

//! Calls work(job, workspace) for each of `count` jobs, in parallel.
template <typename Work> void parallelJobs(int count, WorkspacePool& pool, const Work& work)
{
    parallel_for_(Range(0, count), Jobs<Work>(work, pool));
}

}  // namespace iib
}  // namespace cv

#endif
