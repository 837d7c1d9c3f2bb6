#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "attributes/byte_planes.h"
#include "attributes/ordered_words.h"
#include "attributes/window_table.h"
#include "container/byte_reader.h"
#include "container/byte_writer.h"

namespace bspc::attributes {

// Method quick: differences from the nearest points of a window, packed by zstd a byte plane at a
// time.

struct QuickSettings {
  enum class Domain : std::uint8_t {
    Words = 0,    ///< prediction in ordered words, modulo 2^bits
    Numbers = 1,  ///< in floating-point numbers
    Unit = 2,     ///< three numbers of squares that sum up to one
  };

  NumberKind kind = NumberKind::Unsigned;
  std::uint32_t components = 1;
  Domain domain = Domain::Words;
  bool mean = false;     ///< of three neighbours, the nearest counting twice; else the nearest
  bool chained = false;  ///< a component's residual is told relative to that of the one before
};

/// Appends the words of a sequence of points, or of the first `limit`.
template <class Word>
void writeQuick(const WindowTable& window, const QuickSettings& settings,
                const std::vector<Word>& words, std::size_t limit, PlaneWriter& planes,
                container::ByteWriter& out);

/// Fills in `words`, which has its size.
template <class Word>
void readQuick(container::ByteReader& in, const WindowTable& window, const QuickSettings& settings,
               std::vector<Word>& words);

}  // namespace bspc::attributes
