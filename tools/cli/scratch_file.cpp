#include "cli/scratch_file.h"

#include <stdlib.h>  // mkstemp is POSIX, not C++
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>

#include "bspc/error.h"

namespace bspc::cli {

namespace {

[[noreturn]] void fail(const std::string& what) {
  throw Error(ErrorCode::Io,
              what + " (" + std::strerror(errno) +
                  "); the environment variable TMPDIR says where temporary files go");
}

}  // namespace

ScratchFile::ScratchFile() {
  std::error_code error;
  std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (error) folder = "/tmp";
  std::string name = (folder / "bspc-XXXXXX").string();
  descriptor_ = ::mkstemp(name.data());
  if (descriptor_ < 0) fail("a temporary file cannot be created in " + folder.string());
  ::unlink(name.c_str());
}

ScratchFile::~ScratchFile() { ::close(descriptor_); }

void ScratchFile::read(std::uint64_t offset, Span<std::uint8_t> into) {
  std::uint8_t* to = into.data();
  for (std::size_t left = into.size(); left > 0;) {
    const ssize_t got = ::pread(descriptor_, to, left, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) fail("a temporary file cannot be read");
    to += got;
    offset += static_cast<std::uint64_t>(got);
    left -= static_cast<std::size_t>(got);
  }
}

void ScratchFile::append(ByteView bytes) {
  const std::uint8_t* from = bytes.data();
  for (std::size_t left = bytes.size(); left > 0;) {
    const ssize_t put = ::pwrite(descriptor_, from, left, static_cast<off_t>(size_));
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) fail("a temporary file cannot be written");
    from += put;
    size_ += static_cast<std::uint64_t>(put);
    left -= static_cast<std::size_t>(put);
  }
}

}  // namespace bspc::cli
