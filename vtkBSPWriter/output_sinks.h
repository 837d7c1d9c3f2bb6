#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "bspc/io.h"

namespace bspc::vtk {

/// Appends to a string.
class StringSink final : public ByteSink {
 public:
  void write(ByteView bytes) override;
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// A file that is there whole or not at all: it is written beside its place and renamed when it is
/// finished. Devices and pipes are written directly.
class FileSink final : public ByteSink {
 public:
  /// Of a path in UTF-8. Throws Error(Io) if the file cannot be created.
  explicit FileSink(const std::string& fileName);
  /// Removes what was written unless commit() was reached.
  ~FileSink() override;
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;

  void write(ByteView bytes) override;
  /// Hands on what is kept back, so that others who open writtenPath() find it. Throws Error(Io).
  void flush();
  /// The file beside its place; empty if the place itself is written to.
  std::string writtenPath() const { return temporary_.u8string(); }
  /// Puts the file in its place. Throws Error(Io).
  void commit();
  /// Whether the disk was full when writing failed.
  bool diskFull() const { return diskFull_; }

 private:
  [[noreturn]] void failWriting();

  std::filesystem::path place_;      ///< behind symbolic links
  std::filesystem::path temporary_;  ///< empty if the file is written directly, or is finished
  std::ofstream stream_;
  bool diskFull_ = false;
};

}  // namespace bspc::vtk
