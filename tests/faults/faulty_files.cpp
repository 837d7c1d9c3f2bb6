// To be loaded in front of a program (LD_PRELOAD): its reads and writes are interrupted and cut
// short, and fail where they are told to.
//
//   FAULTY_FILE       of which files: a part of their paths
//   FAULTY_READ_AT    reading fails with EIO from that byte of all that was read on
//   FAULTY_WRITE_AT   writing fails with ENOSPC likewise

#include <dlfcn.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>

namespace {

std::atomic<unsigned> calls{0};
std::atomic<std::size_t> bytesRead{0};
std::atomic<std::size_t> bytesWritten{0};

/// The function of that name in the libraries behind this one.
template <class Function>
Function* behind(const char* name) {
  Function* function = nullptr;
  void* found = ::dlsym(RTLD_NEXT, name);
  std::memcpy(&function, &found, sizeof function);
  return function;
}

std::size_t numberOf(const char* variable) {
  const char* text = std::getenv(variable);
  return text == nullptr ? std::numeric_limits<std::size_t>::max()
                         : static_cast<std::size_t>(std::strtoull(text, nullptr, 10));
}

bool isFaulty(int file) {
  const char* wanted = std::getenv("FAULTY_FILE");
  if (wanted == nullptr) return false;
  std::array<char, PATH_MAX> path{};
  const std::string link = "/proc/self/fd/" + std::to_string(file);
  const ssize_t size = ::readlink(link.c_str(), path.data(), path.size());
  if (size < 0) return false;
  return std::string(path.data(), static_cast<std::size_t>(size)).find(wanted) != std::string::npos;
}

/// How many of `count` bytes the call may take; −1 with errno if it fails.
ssize_t allowed(std::size_t count, std::size_t done, const char* limit, int error) {
  const unsigned call = ++calls;
  if (call % 3 == 0) {
    errno = EINTR;
    return -1;
  }
  const std::size_t last = numberOf(limit);
  if (done >= last) {
    errno = error;
    return -1;
  }
  const std::size_t most = call % 3 == 1 ? 4099 : 7;
  return static_cast<ssize_t>(std::min({count, last - done, most}));
}

ssize_t allowedToRead(std::size_t count) {
  return allowed(count, bytesRead, "FAULTY_READ_AT", EIO);
}
ssize_t allowedToWrite(std::size_t count) {
  return allowed(count, bytesWritten, "FAULTY_WRITE_AT", ENOSPC);
}

ssize_t noted(ssize_t done, std::atomic<std::size_t>& sum) {
  if (done > 0) sum += static_cast<std::size_t>(done);
  return done;
}

}  // namespace

extern "C" {

__attribute__((visibility("default"))) ssize_t read(int file, void* to, std::size_t count) {
  static auto* const plain = behind<ssize_t(int, void*, std::size_t)>("read");
  if (!isFaulty(file)) return plain(file, to, count);
  const ssize_t most = allowedToRead(count);
  return most < 0 ? most : noted(plain(file, to, static_cast<std::size_t>(most)), bytesRead);
}

__attribute__((visibility("default"))) ssize_t write(int file, const void* from,
                                                     std::size_t count) {
  static auto* const plain = behind<ssize_t(int, const void*, std::size_t)>("write");
  if (!isFaulty(file)) return plain(file, from, count);
  const ssize_t most = allowedToWrite(count);
  return most < 0 ? most : noted(plain(file, from, static_cast<std::size_t>(most)), bytesWritten);
}

__attribute__((visibility("default"))) ssize_t writev(int file, const iovec* parts, int count) {
  static auto* const plain = behind<ssize_t(int, const iovec*, int)>("writev");
  if (!isFaulty(file)) return plain(file, parts, count);
  for (int i = 0; i < count; ++i) {
    if (parts[i].iov_len > 0) return write(file, parts[i].iov_base, parts[i].iov_len);
  }
  return 0;
}

}  // extern "C"
