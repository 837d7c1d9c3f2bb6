#include "cli/input_file.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>

#include "bspc/error.h"
#include "cli/interrupts.h"

namespace bspc::cli {

InputFile::InputFile(const std::string& path)
    : name_(path == "-" ? "standard input" : path), standardInput_(path == "-") {
  if (standardInput_) return;
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw Error(ErrorCode::Io, path + ": is a folder, not a file");
  }
  open();
}

void InputFile::open() {
  errno = 0;
  file_.open(name_, std::ios::binary);
  if (!file_) {
    const std::string reason = errno != 0 ? std::strerror(errno) : "unknown reason";
    throw Error(ErrorCode::Io, name_ + ": cannot be opened (" + reason + ")");
  }
}

std::istream& InputFile::stream() { return standardInput_ ? std::cin : file_; }

std::shared_ptr<ByteSource> InputFile::source() {
  if (!standardInput_) {
    // A decoder asks for whole blocks here and there: a buffer would read what nobody asked for.
    // It can only be taken away from a file that is not open.
    file_.close();
    file_.rdbuf()->pubsetbuf(nullptr, 0);
    open();
    return std::make_shared<StreamSource>(file_);
  }
  std::array<char, 1U << 16> piece{};
  while (std::cin.read(piece.data(), piece.size()) || std::cin.gcount() > 0) {
    const auto* data = reinterpret_cast<const std::uint8_t*>(piece.data());
    buffer_.insert(buffer_.end(), data, data + std::cin.gcount());
    if (interrupted()) throw Error(ErrorCode::Cancelled, name_ + ": stopped as asked");
  }
  if (std::cin.bad()) throw Error(ErrorCode::Io, name_ + ": cannot be read to its end");
  return std::make_shared<MemorySource>(buffer_);
}

}  // namespace bspc::cli
