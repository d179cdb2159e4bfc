// Low-discrepancy sample points: Sobol's first two dimensions, Owen-scrambled by hashes and drawn in an order
// of its own for every pair of dimensions of a path. Burley 2020, "Practical Hash-based Owen Scrambling",
// sections 3 (scrambling) and 4 (padding by shuffled pairs).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace lichtveld::reference {

// Stafford's mix 13 (the finaliser of SplitMix64; Steele et al. 2014, section 3): every bit depends on all.
inline std::uint64_t hash(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

// The points of one texel in one batch. Batches share nothing, so that their spread tells the error.
class Sampler {
 public:
  Sampler(std::uint64_t seed, std::uint32_t texel, std::uint32_t batch)
      : key_(hash(hash(seed) ^ (std::uint64_t{texel} << 32 | batch))) {}

  // Begins the path of that number in the batch.
  void begin(std::uint32_t path) {
    path_ = reversed(path);
    pairs_ = 0;
  }

  // The next two dimensions, in [0, 1).
  glm::dvec2 pair() {
    const std::uint64_t order = hash(key_ + 2 * pairs_), scramble = hash(key_ + 2 * pairs_ + 1);
    ++pairs_;
    const std::uint32_t index = reversed(permuted(path_, order));
    return {unit(permuted(index, scramble)), unit(permuted(reversed(sobol(index)), hash(scramble)))};
  }

 private:
  static double unit(std::uint32_t bits_from_low) { return reversed(bits_from_low) * 0x1p-32; }

  static std::uint32_t reversed(std::uint32_t x) {
    x = (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
    x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
    x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
    return __builtin_bswap32(x);
  }

  // Owen's nested scrambling of a number whose lowest bit comes first: each bit is flipped or not by a hash of
  // those below it (Burley's section 3, after Laine and Karras 2011). The exclusive or makes each point uniform
  // by itself.
  static std::uint32_t permuted(std::uint32_t x, std::uint64_t key) {
    x ^= static_cast<std::uint32_t>(key >> 32);
    x += static_cast<std::uint32_t>(key);
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return x;
  }

  // Sobol's second dimension; the first is the reversed index. Each direction number is v ^ v >> 1 of the last.
  static std::uint32_t sobol(std::uint32_t index) {
    std::uint32_t result = 0;
    for (std::uint32_t v = 1u << 31; index != 0; index >>= 1, v ^= v >> 1)
      if (index & 1) result ^= v;
    return result;
  }

  std::uint64_t key_;
  std::uint64_t pairs_ = 0;  // drawn in this path
  std::uint32_t path_ = 0;   // its number, bits reversed
};

}  // namespace lichtveld::reference
