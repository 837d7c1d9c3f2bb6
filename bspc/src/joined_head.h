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

/// The meshes of files that are joined: each keeps its own Mesh blocks.
class JoinedMeshes {
 public:
  /// A block of one of the files.
  struct Source {
    std::size_t file = 0;
    std::size_t block = 0;
    std::uint64_t firstTile = 0;  ///< of the file in the joined one
  };

  /// Takes what a file has whose tiles begin at `firstTile`. Throws Error(InvalidArgument) if its
  /// cells have other arrays than those before it.
  void take(std::size_t file, std::uint64_t firstTile, const container::MeshRecord& mesh);

  const container::MeshRecord& record() const { return record_; }
  const Source& source(std::size_t block) const { return sources_[block]; }

 private:
  container::MeshRecord record_;
  std::vector<Source> sources_;
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
