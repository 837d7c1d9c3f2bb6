#include "formats/output_buffer.h"

#include "formats/model.h"

namespace bspc::formats {

void OutputBuffer::requireGood() {
  if (!out_) throw FormatError("could not write: the output stream has failed");
}

void OutputBuffer::flush() {
  out_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
  text_.clear();
  requireGood();
}

void OutputBuffer::write(const void* data, std::uint64_t size) {
  flush();
  out_.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
  requireGood();
}

void OutputBuffer::finish() {
  flush();
  // Errors of a full disk may show only here.
  out_.flush();
  requireGood();
}

}  // namespace bspc::formats
