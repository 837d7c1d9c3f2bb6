#include "entropy/range_decoder.h"

#include "bspc/error.h"

namespace bspc::entropy {

RangeDecoder::RangeDecoder(ByteView bytes) : bytes_(bytes) {
  const std::uint64_t first = nextWord();
  code_ = (first << 32) | nextWord();
}

std::uint64_t RangeDecoder::lastWord() {
  // The encoder leaves out trailing zero bytes of its last eight, so that many may be missing.
  std::uint64_t word = 0;
  for (unsigned i = 0; i < 4; ++i) {
    word <<= 8;
    if (at_ < bytes_.size()) {
      word |= bytes_[at_++];
    } else if (++missing_ > kMaxMissing) {
      throw Error(ErrorCode::Corrupt,
                  "a range coded stream of " + std::to_string(bytes_.size()) +
                      " bytes ends before its last symbol: the file is damaged");
    }
  }
  return word;
}

void RangeDecoder::expectEnd() const {
  if (at_ < bytes_.size()) {
    throw Error(ErrorCode::Corrupt, "a range coded stream has " +
                                        std::to_string(bytes_.size() - at_) +
                                        " bytes after its last symbol: the file is damaged");
  }
}

}  // namespace bspc::entropy
