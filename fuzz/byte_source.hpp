// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/core.hpp"

#include <cfloat>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>

//! Called by libFuzzer or replay.cpp with each input.
extern "C" int LLVMFuzzerTestOneInput(const uchar* data, size_t size);

//! Ends the run if the library broke a promise; the fuzzer then keeps the input.
#define FUZZ_CHECK(condition)                                                                                \
    do                                                                                                       \
    {                                                                                                        \
        if (!(condition))                                                                                    \
        {                                                                                                    \
            std::fprintf(stderr, "%s:%d: %s does not hold\n", __FILE__, __LINE__, #condition);               \
            std::abort();                                                                                    \
        }                                                                                                    \
    } while (0)

//! Turns the fuzzer's bytes into arguments; zeros follow the last byte.
class ByteSource
{
public:
    ByteSource(const uchar* data, size_t size) : next(data), end(data + size) {}

    template <typename T> T read()
    {
        T value = T();
        const size_t size = std::min(sizeof(T), left());
        if (size > 0)
            std::memcpy(&value, next, size);
        next += size;
        return value;
    }

    size_t left() const { return (size_t)(end - next); }
    //! At most `count` bytes, as far as there are some.
    std::string bytes(size_t count)
    {
        const std::string found((const char*)next, std::min(count, left()));
        next += found.size();
        return found;
    }
    bool flag() { return (read<uchar>() & 1) != 0; }

    //! True once in n times, n <= 256: for slow cases.
    bool rarely(int n) { return between(0, n - 1) == n - 1; }

    //! A number from lo to hi, of at most 65,536.
    int between(int lo, int hi)
    {
        const int count = hi - lo + 1;
        return lo + (count <= 256 ? (int)read<uchar>() : (int)read<ushort>()) % count;
    }

    //! An ordinary number, or one that often breaks code.
    float number()
    {
        static const float special[] = {0.f, -0.f, -1.f, 1e-30f, FLT_MIN / 2, 1e9f, -1e9f, 2147483648.f,
                1e20f, FLT_MAX, -FLT_MAX, std::numeric_limits<float>::infinity(),
                -std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()};
        const int kind = read<uchar>();
        if (kind < 200)
            return (float)read<short>() / 64;
        if (kind < 240)
            return special[kind % (int)(sizeof(special) / sizeof(special[0]))];
        return read<float>();
    }

private:
    const uchar *next, *end;
};

//! Calls cv::setNumThreads only if the number changes, since the call takes as long as a small input.
inline void useThreads(int count)
{
    static int inUse = -1;
    if (count == inUse)
        return;
    cv::setNumThreads(count);
    inUse = count;
}

//! Whether a call throws a cv::Exception. Targets use this for calls that may be refused; any other exception ends the
//! run.
template <typename Call> inline bool refused(const Call& call)
{
    try
    {
        call();
    }
    catch (const cv::Exception&)
    {
        return true;
    }
    return false;
}

//! The parameters that an object writes, as YAML below the name `object`.
template <typename T> cv::String written(const T& object)
{
    cv::FileStorage fs(".yml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
    fs << "object"
       << "{";
    object.write(fs);
    fs << "}";
    return fs.releaseAndGetString();
}

//! Defines a target, FUZZ_TARGET { ... }, which begins on one thread.
#define FUZZ_TARGET                                                                                          \
    static void fuzzTarget(ByteSource& in);                                                                  \
    extern "C" int LLVMFuzzerTestOneInput(const uchar* data, size_t size)                                    \
    {                                                                                                        \
        useThreads(1);                                                                                       \
        ByteSource in(data, size);                                                                           \
        fuzzTarget(in);                                                                                      \
        return 0;                                                                                            \
    }                                                                                                        \
    static void fuzzTarget(ByteSource& in)
