#pragma once

#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>

#include "bspc/io.h"

namespace bspc::cli {

/// A file that is there whole or not at all: it is written beside its place and renamed when it
/// is finished. "-" is standard output; devices and pipes are written directly.
class OutputFile {
 public:
  /// Throws Error(Io) if the file exists and `force` is false, or cannot be created.
  OutputFile(const std::string& path, bool force);
  /// Removes what was written unless commit() was reached.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  std::ostream& stream();
  /// Whether it is a file of its own, in which one can go back; no pipe, no device.
  bool isFile() const { return !temporary_.empty(); }
  /// How to call it in messages.
  std::string name() const { return standardOutput_ ? "standard output" : path_; }
  /// Puts the file in its place. Throws Error(Io).
  void commit();

 private:
  std::string path_;
  std::filesystem::path temporary_;  ///< empty if the file is written directly
  bool force_;
  bool standardOutput_;
  std::ofstream file_;
};

/// What an encoder writes to an output file, which must outlive it. Its errors name that file.
class OutputSink final : public ByteSink {
 public:
  explicit OutputSink(OutputFile& file) : name_(file.name()), sink_(file.stream()) {}
  void write(ByteView bytes) override;

 private:
  std::string name_;
  StreamSink sink_;
};

}  // namespace bspc::cli
