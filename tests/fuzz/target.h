#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bspc/span.h"
#include "choices.h"

namespace bspc::fuzz {

/// Changes `size` bytes in place, to at most `maxSize`, and returns how many there are then.
using ByteMutator = std::size_t (*)(std::uint8_t* data, std::size_t size, std::size_t maxSize);

/// Something that is run with any bytes whatever: it returns, or ends the program at a fault.
struct Target {
  std::string name;
  void (*run)(ByteView input) = nullptr;
  /// Makes another input of one; null: a ByteMutator does.
  Bytes (*mutate)(ByteView input, std::size_t maxSize, Random& random,
                  ByteMutator changeBytes) = nullptr;
  /// Inputs to begin with, beside those in the files of `seedFolders` (below Testing/Data), to each
  /// of which `suffix` zeros are appended.
  std::vector<Bytes> (*seeds)() = nullptr;
  std::vector<std::string> seedFolders;
  std::size_t suffix = 0;
};

/// The targets that are linked into this program.
std::vector<Target> targets();

/// Small files of every method with all sorts of arrays, cells and layouts.
std::vector<Bytes> fileSeeds();

/// One that takes .bspc files.
Target fileTarget(const std::string& name, void (*run)(ByteView input));

Target decodeTarget();
Target queryTarget();
Target roundTripTarget();
Target modelTarget();
Target vtkReaderTarget();

/// Ends the program: what must hold does not.
[[noreturn]] void fail(const std::string& what);

}  // namespace bspc::fuzz
