#include "engine/parallel/reduce.h"
#include "engine/parallel/state_hash.h"
#include "engine/parallel/thread_limit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

using namespace toile;

namespace {

double sum_of_sines(int count) {
  return deterministic_sum(count, 100, [](int begin, int end) {
    double s = 0;
    for (int i = begin; i < end; ++i) s += std::sin(0.1 * i) * std::exp(1e-5 * i);
    return s;
  });
}

}  // namespace

TEST(Parallel, EveryIndexIsVisitedOnce) {
  for (int count : {0, 1, 99, 100, 101, 12345}) {
    std::vector<int> visits(count, 0);
    parallel_for_each(count, 100, [&](int i) { ++visits[i]; });
    EXPECT_EQ(visits, std::vector<int>(count, 1)) << count;
  }
}

TEST(Parallel, SumHasTheSameBitsOnAnyNumberOfThreads) {
  double reference;
  {
    ThreadLimit one(1);
    reference = sum_of_sines(200000);
  }
  for (int threads : {2, 3, 4})
    for (int repeat = 0; repeat < 20; ++repeat) {
      ThreadLimit limit(threads);
      const double sum = sum_of_sines(200000);
      ASSERT_EQ(std::memcmp(&sum, &reference, sizeof sum), 0) << threads << " threads";
    }
}

TEST(Parallel, SumOfNothingIsZero) { EXPECT_EQ(sum_of_sines(0), 0.0); }

TEST(StateHash, KnownDigests) {  // FIPS 180-4 examples
  EXPECT_EQ(sha256_hex(std::span<const std::byte>()),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  const char abc[] = {'a', 'b', 'c'};
  EXPECT_EQ(sha256_hex(std::as_bytes(std::span(abc))),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(StateHash, OneBitChangesIt) {
  Positions a = {Vec3(1, 2, 3), Vec3(4, 5, 6)}, b = a;
  EXPECT_EQ(sha256_hex(a), sha256_hex(b));
  b[1].z() = std::nextafter(6.0, 7.0);
  EXPECT_NE(sha256_hex(a), sha256_hex(b));
}
