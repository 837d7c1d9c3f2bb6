// Memory that runs out, at every allocation: bspc::Error or std::bad_alloc, and nothing is lost.

#include <gtest/gtest.h>

#include <functional>
#include <new>

#include "bspc/error.h"
#include "bspc/join.h"
#include "bspc/part_encoder.h"
#include "bspc/stream_encoder.h"
#include "faults/counted_memory.h"
#include "faults/small_files.h"

namespace bspc {
namespace {

using test::SmallFile;
using test::smallFiles;

/// Runs the action with one allocation after the other failing: each of the first ones, then some.
void expectSafe(const std::function<void()>& action) {
  action();  // what is made once only is there from now on
  constexpr std::uint64_t kEach = 15;
  bool reached = true;
  for (std::uint64_t number = 1; reached; number += 1 + number / kEach) {
    for (const bool allAfter : {false, true}) {
      const std::uint64_t before = test::liveBytes();
      bool failed = false;
      {
        const test::FailingAllocation failing(number, allAfter);
        try {
          action();
        } catch (const std::bad_alloc&) {
          failed = true;
        } catch (const Error&) {
          failed = true;
        }
        reached = failing.reached();
      }
      ASSERT_EQ(test::liveBytes(), before) << "allocation " << number;
      ASSERT_TRUE(failed || !reached || !allAfter) << "allocation " << number;
    }
  }
}

TEST(OutOfMemory, WhileEncodingLosesNothing) {
  for (const SmallFile& file : smallFiles()) {
    SCOPED_TRACE(file.name);
    expectSafe([&] {
      MemorySink sink;
      file.encodeTo(sink);
    });
  }
}

TEST(OutOfMemory, WhileDecodingLosesNothing) {
  for (const SmallFile& file : smallFiles()) {
    SCOPED_TRACE(file.name);
    const Bytes bytes = file.bytes();
    DecodeOptions options;
    options.threads = file.options.threads;
    options.wantCounts = true;
    options.cellLevel = 0;
    expectSafe([&] { test::open(bytes).decode(options); });
  }
}

TEST(OutOfMemory, WhileJoiningAndWritingInPartsLosesNothing) {
  const SmallFile file = smallFiles().front();
  const Bytes bytes = file.bytes();
  const std::vector<std::shared_ptr<ByteSource>> files(2, std::make_shared<MemorySource>(bytes));
  expectSafe([&] {
    MemorySink sink;
    join(files, sink);
  });
  const PointSetView view(file.xyz.data(), file.xyz.size() / 3);
  expectSafe([&] {
    const EncodeOptions agreed = agreeOnParts({describePart(view, file.options)}, file.options);
    frameParts({encodePart(view, agreed).summary});
  });
}

}  // namespace
}  // namespace bspc
