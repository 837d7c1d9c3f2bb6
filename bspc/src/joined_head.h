#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bspc/arrays.h"
#include "container/file_head.h"

namespace bspc {

/// The arrays of files that are joined.
class JoinedTables {
 public:
  /// Takes the table of a file that has points. Throws Error(InvalidArgument) if it has other
  /// arrays than those before it.
  void take(std::size_t file, const container::FileHead& head);

  const std::vector<ArrayDescription>& arrays() const { return arrays_; }
  bool keepsOrder() const { return any_ && keepsOrder_; }
  /// Where an array of arrays() stands in the table of a file that was taken.
  std::size_t indexIn(std::size_t file, std::size_t array) const { return indices_[file][array]; }

 private:
  bool any_ = false;
  bool keepsOrder_ = true;
  std::vector<ArrayDescription> arrays_;
  std::vector<std::vector<std::size_t>> indices_;  ///< by file, then by array
};

/// The metadata of files that are joined.
class JoinedMetadata {
 public:
  /// Throws Error(InvalidArgument) if the file's coordinates mean something else than those of the
  /// files before it.
  void take(std::size_t file, const Metadata& metadata);

  const Metadata& metadata() const { return metadata_; }
  const std::vector<std::string>& dropped() const { return dropped_; }

 private:
  Metadata metadata_;
  std::vector<std::string> dropped_;
};

}  // namespace bspc
