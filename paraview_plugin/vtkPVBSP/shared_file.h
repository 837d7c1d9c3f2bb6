#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "bspc/span.h"
#include "process_group.h"
#include "vtkBSPWriter/output_sinks.h"

namespace bspc::vtk {

/// A file that several processes write at a time, each at its own place. It is written beside its
/// place and renamed when it is finished, or removed. Every call must be made by all processes.
class SharedFile {
 public:
  /// Begins the file with `head`. Throws Error(Io) on all if it cannot be created, or if there is a
  /// process that does not see it.
  SharedFile(ProcessGroup& group, const std::string& fileName, const Bytes& head);

  /// Each writes its part.
  void write(const Bytes& part, std::uint64_t offset);
  /// Writes `end` and puts the file in its place.
  void finish(const Bytes& end, std::uint64_t offset);

 private:
  void writeAt(const Bytes& bytes, std::uint64_t offset) const;

  ProcessGroup& group_;
  std::unique_ptr<FileSink> file_;  ///< on the first process, which owns the file
  std::string path_;                ///< of what is written, known to all
};

}  // namespace bspc::vtk
