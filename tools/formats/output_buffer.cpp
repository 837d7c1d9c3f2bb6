#include "formats/output_buffer.h"

#include <algorithm>

#include "bspc/error.h"
#include "formats/model.h"

namespace bspc::formats {

void OutputBuffer::requireGood() {
  if (!out_) throw FormatError("could not write: the output stream has failed");
}

void OutputBuffer::report(std::uint64_t done, std::uint64_t all) {
  if (!progress_) return;
  if (!progress_(static_cast<double>(done) / static_cast<double>(all))) {
    throw Error(ErrorCode::Cancelled, "stopped as asked");
  }
}

void OutputBuffer::flush() {
  out_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
  text_.clear();
  requireGood();
}

void OutputBuffer::write(const void* data, std::uint64_t size) {
  flush();
  constexpr std::uint64_t kPiece = std::uint64_t{1} << 22;
  const auto* bytes = static_cast<const char*>(data);
  for (std::uint64_t done = 0; done < size;) {
    const std::uint64_t piece = std::min(kPiece, size - done);
    out_.write(bytes + done, static_cast<std::streamsize>(piece));
    requireGood();
    done += piece;
    report(done, size);
  }
}

void OutputBuffer::overwriteStart(const std::string& bytes) {
  flush();
  const std::ostream::pos_type end = out_.tellp();
  if (start_ == std::ostream::pos_type(-1) || end == std::ostream::pos_type(-1)) return;
  out_.seekp(start_);
  out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out_.seekp(end);
  requireGood();
}

void OutputBuffer::finish() {
  flush();
  // Errors of a full disk may show only here.
  out_.flush();
  requireGood();
}

}  // namespace bspc::formats
