#!/bin/sh
# Makes the figures of doc/reliability.md, step by step, on a machine with hours to spare; each step ends with an
# error if it finds one. scripts/reliability.sh [STEP...], of:
# bits sanitize stress mutation fuzz versions arm64 wheel presets
. "$(dirname "$0")/lib.sh"

known="bits sanitize stress mutation fuzz versions arm64 wheel presets"
# shellcheck disable=SC2086
[ $# -gt 0 ] || set -- $known
for step in "$@"; do
    case " $known " in
    *" $step "*) ;;
    *) fail "there is no step $step; there are: $known" ;;
    esac
done
# shellcheck disable=SC2086
need $build_packages clang xz-utils
for step in "$@"; do
    say "$step"
    case "$step" in
    bits)
        for compiler in g++ clang++; do
            for level in 0 3; do
                folder="$root/build-$compiler-O$level"
                cmake -S "$root" -B "$folder" -G Ninja -DCMAKE_CXX_COMPILER=$compiler -DIIB_BUILD_TOOLS=OFF \
                    "-DCMAKE_CXX_FLAGS_RELEASE=-O$level" >/dev/null
                cmake --build "$folder" --target opencv_test_iib
                for off in "" AVX512-SKX,AVX512-ICL AVX2,AVX512-SKX,AVX512-ICL \
                    SSE4.1,SSE4.2,AVX,AVX2,AVX512-SKX,AVX512-ICL; do
                    for threads in 1 2 4 8; do
                        OPENCV_CPU_DISABLE=$off OPENCV_FOR_THREADS_NUM=$threads "$folder/opencv_test_iib" \
                            --gtest_filter='IIB_Golden*' >"$folder/golden.log" 2>&1 || {
                            cat "$folder/golden.log"
                            exit 1
                        }
                        echo "$compiler -O$level, without ${off:-nothing}, $threads threads:" \
                            "$(tail -n 1 "$folder/golden.log")"
                    done
                done
            done
        done
        ;;
    sanitize) "$root/scripts/test.sh" --sanitize ;;
    stress)
        configure -DIIB_BUILD_TESTS=ON -DIIB_BUILD_TOOLS=ON
        cmake --build "$build" --target iib_stress iib_fault_injection iib_thread_number
        for stress in keypoints codes pixels threads; do
            "$build/tools/stress/iib_stress" $stress
        done
        "$build/tools/stress/iib_fault_injection"
        crashes=0
        for run in 1 2 3 4 5 6 7; do
            "$build/tools/stress/iib_thread_number" || crashes=$((crashes + 1))
        done
        echo "OpenCV alone, its number of threads changed meanwhile: $crashes of $run runs crashed"
        ;;
    mutation) "$root/scripts/mutation.sh" ;;
    fuzz)
        "$root/scripts/fuzz.sh" --plain -s 1800 matcher descriptor
        "$root/scripts/fuzz.sh" -s 600
        ;;
    versions) "$root/scripts/versions.sh" ;;
    arm64) "$root/scripts/arm64.sh" ;;
    wheel) "$root/scripts/wheel.sh" --test ;;
    presets)
        "$root/scripts/train.sh" --presets --seed=1
        git -C "$root" diff --exit-code -- modules/iib/src/descriptor/presets.generated.hpp
        ;;
    esac
done
