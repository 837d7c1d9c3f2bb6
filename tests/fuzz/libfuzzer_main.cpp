// One target as a libFuzzer program.

#include <algorithm>

#include "target.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t maxSize);

namespace {

const bspc::fuzz::Target& target() {
  static const bspc::fuzz::Target kTarget = bspc::fuzz::BSPC_FUZZ_TARGET();
  return kTarget;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  target().run(bspc::ByteView(data, size));
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t maxSize, unsigned int seed) {
  if (target().mutate == nullptr) return LLVMFuzzerMutate(data, size, maxSize);
  bspc::fuzz::Random random(seed);
  const bspc::Bytes changed =
      target().mutate(bspc::ByteView(data, size), maxSize, random, LLVMFuzzerMutate);
  std::copy(changed.begin(), changed.end(), data);
  return changed.size();
}
