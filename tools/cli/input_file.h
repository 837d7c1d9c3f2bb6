#pragma once

#include <fstream>
#include <istream>
#include <memory>
#include <string>

#include "bspc/io.h"

namespace bspc::cli {

/// An input of the command: a file, or "-" for standard input.
class InputFile {
 public:
  /// Throws Error(Io) that names the file if it cannot be opened.
  explicit InputFile(const std::string& path);

  std::istream& stream();
  /// Its bytes as a source for a decoder; standard input is read to its end.
  std::shared_ptr<ByteSource> source();
  /// How to call it in messages.
  const std::string& name() const { return name_; }

 private:
  void open();

  std::string name_;
  bool standardInput_;
  std::ifstream file_;
  Bytes buffer_;
};

}  // namespace bspc::cli
