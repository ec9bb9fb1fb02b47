#!/bin/sh
# Creates branches of modules/iib in a checkout of opencv_contrib, each a pull request on top of the previous one:
#   iib-descriptor  the descriptor alone, upright, for 8-bit images, in universal intrinsics; as upstream/descriptor has it
#   iib-matcher     HierarchicalMatcher, with scans in plain C++
#   iib-hamming     the same scans in universal intrinsics, about 20 times as fast
#   iib-files       index files, parameter files
#   iib-detector    HessianDetector, on the locally normalized image
#   iib-normalized  NormalizedDetector, for any other detector
#   iib-refinement  refineMatches, propagateMatches
#   iib-kernels     loops over pixels and cells, for each instruction set, not used yet
#   iib-steps       images and keypoints to bits by these kernels, not used yet
#   iib-presets     the whole descriptor: all mappings, presets, boxes, orientation, files
#   iib-bits        compares its bits with naive oracles
#   iib-rotation    matchRotated, and tests of rotation
#   iib-checks      further tests of the descriptor: wrong arguments, files, threads
#   iib-matching    further tests of the matcher: wrong arguments, files, threads
#   iib-whole       further tests, speed, samples, tutorials; without test/real, whose images are not in opencv_extra
# The detector comes before the presets, since createRecommended() needs both. Before iib-presets, files of upstream/BRANCH replace
# those of modules/iib. upstream/FROM.BEFORE.patch changes the files of modules/iib in the branches from FROM on, before BEFORE.
# A pull request's text is its commit's message.
# Checks each branch as OpenCV would: whitespace, licence in every source, size, number of files. Checks Doxygen's warnings and
# the Java wrappers of OpenCV's generator for the first and the last branch.
#   scripts/upstream.sh [--test | --sizes] FOLDER
# --test: also builds and tests each branch in the newest OpenCV 4, and the first and the last one in OpenCV 5.
# --sizes: only creates the branches and checks their sizes.
. "$(dirname "$0")/helpers/lib.sh"

test="" sizes=""
case "${1:-}" in
--test)
    test=yes
    shift
    ;;
--sizes)
    sizes=yes
    shift
    ;;
esac
branches="descriptor matcher hamming files detector normalized refinement kernels steps presets bits rotation checks matching whole"
[ $# = 1 ] || fail "takes the folder of a checkout of opencv_contrib"
folder=$1
[ -d "$folder/modules" ] || fail "$folder is no checkout of opencv_contrib: it has no modules/"
git -C "$folder" rev-parse --verify -q HEAD >/dev/null || fail "$folder is no git repository with a commit"
[ -z "$(git -C "$folder" status --porcelain)" ] || fail "$folder has changes that are not committed"
for branch in $branches; do
    ! git -C "$folder" rev-parse --verify -q "iib-$branch" >/dev/null || fail "$folder has a branch iib-$branch already: delete it"
done
[ -n "$sizes" ] || {
    need $build_packages doxygen git python3 xz-utils
    source=$("$root/scripts/helpers/opencv_source.sh")
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# The largest size of a branch's patch in bytes, and the largest number of files.
limit_of() {
    case "$1" in
    descriptor) echo 160000 25 ;;
    *) echo 120000 40 ;;
    esac
}

# The branch that adds a file of modules/iib; none for tests on images that are not in opencv_extra.
branch_of() {
    case "${1#modules/iib/}" in
    test/real/*) ;;
    */kernels/mappings.hpp | */orientation.hpp | */features.hpp | test/test_main.cpp | perf/perf_main.cpp) echo descriptor ;;
    */textures.* | */oracle_pixels.hpp) echo descriptor ;;
    CMakeLists.txt | cmake/* | src/precomp.hpp | test/test_precomp.hpp | */detail/code_layout.hpp | */detail/packed_codes.hpp) echo matcher ;;
    */index_file.* | */checked_file.* | */detail/files.hpp | src/common/files.cpp | */temporary_file.hpp | */test_index_file.cpp) echo files ;;
    */matcher/kernels/*.simd.hpp | src/common/vectors.simd.hpp | */test_hamming.cpp) echo hamming ;;
    */iib/matcher.hpp | src/matcher/* | */outputs.hpp | src/common/file_numbers.hpp | */test_errors.hpp) echo matcher ;;
    */test_matcher.cpp | */matcher_oracle.* | */random_descriptors.hpp) echo matcher ;;
    */aligned_buffer.hpp | */test_matcher_chunks.cpp) echo hamming ;;
    */iib/hessian_detector.hpp | */detector/kernels/* | src/detector/hessian* | */blobs.* | */scale_space.*) echo detector ;;
    src/normalization/* | src/common/image_input.* | src/common/grey.*) echo detector ;;
    */hessian_oracle.* | */test_hessian_detector.cpp | */normalization_oracle.* | */test_images.*) echo detector ;;
    *normalized_detector.* | */detector_file.* | */test_local_normalization.cpp | */seen_image.hpp) echo normalized ;;
    */iib/refinement.hpp | */prepared_image.hpp | src/refinement/* | src/common/geometry.hpp | doc/iib.bib) echo refinement ;;
    */refinement_scene.* | */test_refinement_bits.cpp | */test_propagation.cpp) echo refinement ;;
    */rotation[/.]* | include/opencv2/iib.hpp | */test_match_rotated.cpp | */test_rotated.cpp | */test_orientation.cpp) echo rotation ;;
    */extractor.cpp | */presets.* | */iib/descriptor.hpp) echo presets ;;
    */test_descriptor_golden.cpp | */test_descriptor_parameters.cpp | perf/perf_precomp.hpp | perf/perf_descriptor.cpp) echo presets ;;
    README.md) echo presets ;;
    doc/format.md) echo bits ;;
    */kernels/boxes.simd.hpp) echo steps ;;
    src/descriptor/kernels/* | src/descriptor/plan.* | src/descriptor/parameters.* | src/common/bit_io.hpp | */detail/places.hpp) echo kernels ;;
    */test_descriptor_kernels.cpp) echo kernels ;;
    src/descriptor/* | */test_keypoint_batches.cpp) echo steps ;;
    */test_descriptor_bits.cpp | */descriptor_oracle.* | */box_oracle.cpp | */describe.* | */test_boxes.cpp) echo bits ;;
    test/descriptor/* | */test_hessian_input.cpp) echo checks ;;
    test/matcher/*) echo matching ;;
    *) echo whole ;;
    esac
}
git -C "$root" ls-files modules/iib | while read -r file; do
    branch=$(branch_of "$file")
    [ -z "$branch" ] || echo "${file#modules/iib/}" >>"$work/$branch"
done

subject() {
    case "$1" in
    descriptor) echo "Added iib module: illumination-insensitive binary descriptor" ;;
    matcher) echo "iib: exact and coarse-to-fine matching of binary descriptors" ;;
    hamming) echo "iib: scans of the matcher in universal intrinsics" ;;
    files) echo "iib: index files of the matcher" ;;
    detector) echo "iib: keypoints that change little with the light" ;;
    normalized) echo "iib: any detector on an image that is normalized locally" ;;
    refinement) echo "iib: matches to a fraction of a pixel, with covariances" ;;
    kernels) echo "iib: kernels of the descriptor for each instruction set" ;;
    steps) echo "iib: batches of keypoints, channels and sums for the descriptor" ;;
    presets) echo "iib: learned selections, boxes, orientation and other depths for the descriptor" ;;
    bits) echo "iib: tests of the descriptor's bits beside naive oracles" ;;
    rotation) echo "iib: matches of images that are rotated by one angle" ;;
    checks) echo "iib: tests of the descriptor's input, parameters, files and threads" ;;
    matching) echo "iib: tests of the matcher's parameters, index files and threads" ;;
    whole) echo "iib: tests of the refinement, performance, tutorials" ;;
    esac
}

# number_of BRANCH: its place among the branches.
number_of() { echo "$branches " | grep -o "^.*\b$1 " | wc -w; }

# lay BRANCH: copies the files of this branch and the previous ones, with their replacements and patches.
lay() {
    module="$folder/modules/iib"
    rm -rf "$module"
    mkdir -p "$module"
    here=$(number_of "$1") early=""
    [ "$here" -lt "$(number_of presets)" ] || early=yes # what replaces files before iib-presets is gone
    for part in $branches; do
        tar -C "$root/modules/iib" -T "$work/$part" -c | tar -C "$module" -x
        [ "$part" != presets ] || early=""
        if [ -d "$root/upstream/$part" ] && [ -z "$early" ]; then cp -R "$root/upstream/$part/." "$module"; fi
        [ "$part" != "$1" ] || break
    done
    for patch in "$root"/upstream/*.patch; do
        range=$(basename "$patch" .patch)
        if [ "$here" -ge "$(number_of "${range%.*}")" ] && [ "$here" -lt "$(number_of "${range#*.}")" ]; then
            git -C "$folder" apply --whitespace=nowarn -p0 --directory=modules/iib "$patch"
        fi
    done
}

# check_documents CLASS...: licence in every source, Doxygen's warnings, and Java wrappers of these classes.
check_documents() {
    git -C "$folder" ls-files modules/iib | while read -r file; do
        case "$file" in
        *.cpp | *.hpp | *.py)
            head -n 4 "$folder/$file" | grep -q "This file is part of OpenCV project" || fail "$file has no licence at its head"
            ;;
        esac
        [ ! -x "$folder/$file" ] || fail "$file is executable"
    done

    say "Doxygen"
    {
        sed '/^EXCLUDE_PATTERNS/,/tools/d; /^USE_MDFILE/d; /^IMAGE_PATH/d' "$root/doc/Doxyfile"
        echo "INPUT = \"$folder/modules/iib/include\" \"$folder/modules/iib/tutorials\""
        echo "EXAMPLE_PATH = \"$folder/modules/iib/samples\""
        echo "OUTPUT_DIRECTORY = \"$work\""
    } | doxygen -

    say "wrappers for Java"
    "$python3" - "$source" "$folder/modules/iib" "$work/java.json" <<'PYTHON'
import json
import os
import pathlib
import sys

source, module = pathlib.Path(sys.argv[1]), os.path.abspath(sys.argv[2])
modules = [(name, 'modules/' + name) for name in ('core', 'imgproc', 'features2d')] + [('iib', os.path.relpath(module, source))]
# Files that CMake would fill in: as they are.
templates = [str(path.relative_to(source)) for path in source.glob('modules/*/**/java/**/*.in')]
pathlib.Path(sys.argv[3]).write_text(json.dumps({
    'rootdir': str(source),
    'modules': [{'name': name, 'location': location} for name, location in modules],
    'files_remap': [{'src': path, 'target': str(source / path)} for path in templates]}))
PYTHON
    (cd "$work" && "$python3" "$source/modules/java/generator/gen_java.py" -p "$source/modules/python/src2/gen2.py" \
        -c "$work/java.json" >"$work/log" 2>&1) || {
        tail -n 5 "$work/log" >&2
        exit 1
    }
    for class in "$@"; do
        [ -f "$work/gen/java/org/opencv/iib/$class.java" ] || fail "the class $class has no wrapper for Java"
    done
    ! sed -n '/=== MODULE: iib/,$p' "$work/gen_java.log" | grep "^SKIP" || fail "these have no wrappers for Java"
}

for branch in $branches; do
    say "the branch iib-$branch in $folder"
    git -C "$folder" switch -q -c "iib-$branch"
    lay "$branch"
    git -C "$folder" add -A modules/iib
    {
        subject "$branch"
        [ ! -e "$root/upstream/$branch.md" ] || { echo && grep -v "^<!-- " "$root/upstream/$branch.md"; }
    } >"$work/message"
    git -C "$folder" commit -q --cleanup=whitespace -F "$work/message"
    git -C "$folder" -c core.whitespace=trailing-space,space-before-tab,tab-in-indent,tabwidth=4 diff --check HEAD^ HEAD ||
        fail "whitespace errors, as above"
    bytes=$(git -C "$folder" diff --binary HEAD^ HEAD | wc -c)
    files=$(git -C "$folder" diff --name-only HEAD^ HEAD | wc -l)
    say "the patch has $bytes bytes in $files files"
    # shellcheck disable=SC2046
    set -- $(limit_of "$branch")
    if [ "$bytes" -gt "$1" ] || [ "$files" -gt "$2" ]; then
        fail "iib-$branch may have $1 bytes in $2 files"
    fi
    case "$sizes,$branch" in
    ,descriptor) check_documents IIBDescriptorExtractor ;;
    ,whole) check_documents IIBDescriptorExtractor HessianDetector HierarchicalMatcher NormalizedDetector ;;
    esac
    [ -z "$test" ] || {
        "$root/scripts/intree.sh" --short --modules "$folder/modules" --source contrib
        case "$branch" in descriptor | whole) "$root/scripts/intree.sh" --short --modules "$folder/modules" --source contrib-5 ;; esac
    }
done
[ -n "$sizes" ] || say "the branches in $folder pass: push each, and open a pull request for it"
