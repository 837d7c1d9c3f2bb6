#include "shared_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "bspc/error.h"

namespace bspc::vtk {

namespace {

std::string reasonOf(int error) { return error != 0 ? std::strerror(error) : "unknown reason"; }

}  // namespace

SharedFile::SharedFile(ProcessGroup& group, const std::string& fileName, const Bytes& head)
    : group_(group) {
  Bytes path;
  group_.step([&] {
    if (group_.rank() != 0) return;
    file_ = std::make_unique<FileSink>(fileName);
    if (file_->writtenPath().empty()) {
      throw Error(ErrorCode::Io, "is no regular file, which several processes need to write to");
    }
    file_->write(head);
    file_->flush();
    const std::string text = file_->writtenPath();
    path.assign(text.begin(), text.end());
  });
  const Bytes told = group_.gatherEverywhere(path)[0];
  path_.assign(told.begin(), told.end());
}

void SharedFile::writeAt(const Bytes& bytes, std::uint64_t offset) const {
  errno = 0;
  std::fstream stream(std::filesystem::u8path(path_),
                      std::ios::binary | std::ios::in | std::ios::out);
  if (!stream) {
    throw Error(ErrorCode::Io, "cannot write to the file that the first process has created (" +
                                   reasonOf(errno) + "); all need one file system");
  }
  stream.seekp(static_cast<std::streamoff>(offset));
  stream.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (stream.fail()) throw Error(ErrorCode::Io, "could not be written (" + reasonOf(errno) + ")");
}

void SharedFile::write(const Bytes& part, std::uint64_t offset) {
  group_.step([&] { writeAt(part, offset); });
}

void SharedFile::finish(const Bytes& end, std::uint64_t offset) {
  group_.step([&] {
    if (group_.rank() != 0) return;
    writeAt(end, offset);
    file_->commit();
  });
}

}  // namespace bspc::vtk
