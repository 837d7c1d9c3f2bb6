#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>

#include "parallel.h"

namespace bspc {
namespace {

TEST(OrderedParallel, HandsResultsOverInOrder) {
  for (const unsigned threads : {1U, 2U, 7U}) {
    std::vector<std::size_t> seen;
    OrderedParallel<std::size_t>(500, threads, [](std::size_t i) { return i * i; })
        .run(
            [&seen](std::size_t i, std::size_t square) {
              EXPECT_EQ(square, i * i);
              seen.push_back(i);
            },
            {});
    std::vector<std::size_t> expected(500);
    std::iota(expected.begin(), expected.end(), 0U);
    EXPECT_EQ(seen, expected);
  }
}

TEST(OrderedParallel, NothingToDoIsDoneAtOnce) {
  OrderedParallel<int>(0, 4, [](std::size_t) {
    return 1;
  }).run([](std::size_t, int) { FAIL() << "there is no result"; }, {});
}

TEST(OrderedParallel, FewResultsWait) {
  std::atomic<int> waiting{0};
  std::atomic<int> most{0};
  OrderedParallel<int>(200, 3, [&](std::size_t) {
    const int now = ++waiting;
    int seen = most;
    while (now > seen && !most.compare_exchange_weak(seen, now)) {
    }
    return 0;
  }).run([&waiting](std::size_t, int) { --waiting; }, {});
  // Twice as many as threads, and the one that is being consumed.
  EXPECT_LE(most, 7);
}

TEST(OrderedParallel, TheFirstFailureIsReportedWhicheverThreadMeetsOne) {
  for (int run = 0; run < 20; ++run) {
    std::size_t consumed = 0;
    try {
      OrderedParallel<int>(100, 4, [](std::size_t i) -> int {
        if (i >= 30) throw std::runtime_error(std::to_string(i));
        return 0;
      }).run([&consumed](std::size_t, int) { ++consumed; }, {});
      FAIL() << "did not throw";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "30");
    }
    EXPECT_EQ(consumed, 30U);
  }
}

TEST(OrderedParallel, IdleMayEndIt) {
  int calls = 0;
  EXPECT_THROW(OrderedParallel<int>(1000000, 2, [](std::size_t) { return 0; })
                   .run([](std::size_t, int) {},
                        [&calls] {
                          if (++calls == 10) throw std::runtime_error("enough");
                        }),
               std::runtime_error);
}

}  // namespace
}  // namespace bspc
