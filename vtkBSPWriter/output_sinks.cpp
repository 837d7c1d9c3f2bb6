#include "vtkBSPWriter/output_sinks.h"

#include <cerrno>
#include <cstring>
#include <random>
#include <system_error>

#include "bspc/error.h"

namespace bspc::vtk {

namespace fs = std::filesystem;

namespace {

std::string reasonOf(int error) { return error != 0 ? std::strerror(error) : "unknown reason"; }

}  // namespace

void StringSink::write(ByteView bytes) {
  bytes_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

FileSink::FileSink(const std::string& fileName) : place_(fs::u8path(fileName)) {
  std::error_code error;
  const fs::file_status status = fs::status(place_, error);
  if (fs::is_directory(status)) throw Error(ErrorCode::Io, "is a folder, not a file");
  // What a link points to is replaced, not the link.
  if (fs::exists(status)) place_ = fs::canonical(place_, error);
  const bool direct = fs::exists(status) && !fs::is_regular_file(status);
  const fs::path written =
      direct ? place_ : fs::path(place_).concat(".part" + std::to_string(std::random_device()()));
  errno = 0;
  stream_.open(written, std::ios::binary | std::ios::trunc);
  if (!stream_) throw Error(ErrorCode::Io, "cannot be created (" + reasonOf(errno) + ")");
  if (!direct) temporary_ = written;
}

FileSink::~FileSink() {
  if (temporary_.empty()) return;
  stream_.close();
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void FileSink::failWriting() {
  diskFull_ = errno == ENOSPC;
  throw Error(ErrorCode::Io, "could not be written (" + reasonOf(errno) + ")");
}

void FileSink::write(ByteView bytes) {
  errno = 0;
  stream_.write(reinterpret_cast<const char*>(bytes.data()),
                static_cast<std::streamsize>(bytes.size()));
  if (!stream_) failWriting();
}

void FileSink::flush() {
  errno = 0;
  stream_.flush();
  if (!stream_) failWriting();
}

void FileSink::commit() {
  errno = 0;
  stream_.close();
  if (stream_.fail()) failWriting();
  if (temporary_.empty()) return;
  std::error_code error;
  fs::rename(temporary_, place_, error);
  if (error) {
    throw Error(ErrorCode::Io, "could not be put in its place (" + error.message() + ")");
  }
  temporary_.clear();
}

}  // namespace bspc::vtk
