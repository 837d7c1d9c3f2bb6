#include "cli/output_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iostream>
#include <system_error>

#include "bspc/error.h"
#include "cli/interrupts.h"
#include "cli/naming.h"

namespace bspc::cli {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& what) {
  throw Error(ErrorCode::Io, path + ": " + what);
}

void refuseExisting(const std::string& path) {
  fail(path, "the file exists already; use --force to replace it");
}

}  // namespace

OutputFile::OutputFile(const std::string& path, bool force)
    : path_(path), force_(force), standardOutput_(path == "-") {
  if (standardOutput_) return;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  const bool exists = fs::exists(status);
  if (exists && fs::is_directory(status)) fail(path, "is a folder");
  // A device or a pipe is a place to write to, not a file to replace.
  const bool direct = exists && !fs::is_regular_file(status);
  if (exists && !direct && !force) refuseExisting(path);
  if (!direct) {
    temporary_ = path + ".part" + std::to_string(::getpid());
    setUnfinishedFile(temporary_.string());
  }
  errno = 0;
  file_.open(direct ? fs::path(path) : temporary_, std::ios::binary | std::ios::trunc);
  if (!file_) {
    const std::string reason = errno != 0 ? std::strerror(errno) : "unknown reason";
    temporary_.clear();
    setUnfinishedFile("");
    fail(path, "cannot be created (" + reason + ")");
  }
}

OutputFile::~OutputFile() {
  if (temporary_.empty()) return;
  file_.close();
  std::error_code ignored;
  fs::remove(temporary_, ignored);
  setUnfinishedFile("");
}

std::ostream& OutputFile::stream() { return standardOutput_ ? std::cout : file_; }

void OutputFile::commit() {
  if (standardOutput_) {
    std::cout.flush();
    if (!std::cout) fail("standard output", "could not be written");
    return;
  }
  file_.close();
  if (file_.fail()) fail(path_, "could not be written; is the disk full?");
  if (temporary_.empty()) return;
  if (!force_ && fs::exists(path_)) refuseExisting(path_);
  std::error_code error;
  fs::rename(temporary_, path_, error);
  if (error) fail(path_, "could not be put in its place (" + error.message() + ")");
  temporary_.clear();
  setUnfinishedFile("");
}

void OutputSink::write(ByteView bytes) {
  try {
    sink_.write(bytes);
  } catch (const Error& error) {
    throw NamedError(error.code(), name_ + ": " + error.what());
  }
}

}  // namespace bspc::cli
