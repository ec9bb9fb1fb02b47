// SPDX-License-Identifier: Apache-2.0

#include "sha256.hpp"

#include <array>
#include <cstdint>
#include <fstream>
#include <vector>

#include "opencv2/core.hpp"

namespace iib_localization {
namespace {

constexpr size_t BLOCK = 64;  // bytes
typedef std::array<uint32_t, 8> State;

uint32_t turned(uint32_t x, int bits) { return x >> bits | x << (32 - bits); }

// 32 bits behind the point of the first primes' square roots, and of their cube roots.
const State START = {
        0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
const uint32_t ROOTS[64] = {0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1,
        0x923f82a4, 0xab1c5ed5, 0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe,
        0x9bdc06a7, 0xc19bf174, 0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa,
        0x5cb0a9dc, 0x76f988da, 0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147,
        0x06ca6351, 0x14292967, 0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb,
        0x81c2c92e, 0x92722c85, 0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624,
        0xf40e3585, 0x106aa070, 0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a,
        0x5b9cca4f, 0x682e6ff3, 0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb,
        0xbef9a3f7, 0xc67178f2};

void addBlock(State& state, const uchar* bytes)
{
    uint32_t w[64];
    for (int i = 0; i < 16; i++)
        w[i] = uint32_t(bytes[4 * i]) << 24 | uint32_t(bytes[4 * i + 1]) << 16 |
               uint32_t(bytes[4 * i + 2]) << 8 | bytes[4 * i + 3];
    for (int i = 16; i < 64; i++)
    {
        const uint32_t a = w[i - 15], b = w[i - 2];
        w[i] = w[i - 16] + (turned(a, 7) ^ turned(a, 18) ^ a >> 3) + w[i - 7] +
               (turned(b, 17) ^ turned(b, 19) ^ b >> 10);
    }
    auto [a, b, c, d, e, f, g, h] = state;
    for (size_t i = 0; i < 64; i++)
    {
        const uint32_t choice = (e & f) ^ (~e & g), majority = (a & b) ^ (a & c) ^ (b & c);
        const uint32_t t = h + (turned(e, 6) ^ turned(e, 11) ^ turned(e, 25)) + choice + ROOTS[i] + w[i];
        h = g;
        g = f;
        f = e;
        e = d + t;
        d = c;
        c = b;
        b = a;
        a = t + (turned(b, 2) ^ turned(b, 13) ^ turned(b, 22)) + majority;
    }
    const State sum = {a, b, c, d, e, f, g, h};
    for (size_t i = 0; i < 8; i++)
        state[i] += sum[i];
}

}  // namespace

std::string sha256OfFile(const std::string& path)
{
    std::ifstream stream(path, std::ios::binary);
    if (!stream)
        return "";
    State state = START;
    std::vector<uchar> buffer(1 << 20);
    uint64_t length = 0;
    for (bool more = true; more;)
    {
        stream.read(reinterpret_cast<char*>(buffer.data()), std::streamsize(buffer.size()));
        size_t size = size_t(stream.gcount());
        length += size;
        more = size == buffer.size();
        std::vector<uchar> last;
        if (!more)  // a one, zeros, and the length in bits, highest byte first
        {
            last.assign(buffer.begin(), buffer.begin() + std::ptrdiff_t(size));
            last.push_back(0x80);
            while (last.size() % BLOCK != BLOCK - 8)
                last.push_back(0);
            for (int shift = 56; shift >= 0; shift -= 8)
                last.push_back(uchar(8 * length >> shift));
        }
        const std::vector<uchar>& bytes = more ? buffer : last;
        for (size_t i = 0; i < bytes.size(); i += BLOCK)
            addBlock(state, &bytes[i]);
    }
    std::string digits;
    for (uint32_t word : state)
        digits += cv::format("%08x", word);
    return digits;
}

}  // namespace iib_localization
