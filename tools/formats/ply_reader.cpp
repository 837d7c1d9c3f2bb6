#include "formats/ply_reader.h"

#include <algorithm>
#include <utility>

#include "formats/array_tuples.h"
#include "formats/ply_body.h"
#include "formats/ply_header.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

class PlyStream : public PointStream {
 public:
  explicit PlyStream(InputBuffer in)
      : in_(std::move(in)), text_(in_), header_(readPlyHeader(text_)) {
    const bool isText = header_.encoding == PlyEncoding::Ascii;
    body_ = isText ? asciiPlyBody(text_, header_) : binaryPlyBody(in_, header_);
    info_.type = header_.positionType;
    info_.otherContent = otherPlyContent(header_, false);
    for (const PlyElement& element : header_.elements) {
      mayHaveMesh_ = mayHaveMesh_ || (element.count > 0 && plyFaceList(element));
    }
    info_.arrays = arraysOf(header_.arrays);
    keepLines("ply.comment", header_.comments);
    keepLines("ply.obj_info", header_.infos);
    const PlyElement& vertices = header_.vertices();
    reservable_ = in_.reservable(vertices.count, vertices.leastBytes(header_.encoding));
  }

  void keepMesh() override {
    PointStream::keepMesh();
    info_.otherContent = otherPlyContent(header_, true);
  }

  std::size_t read(std::uint8_t* positions, Span<ArrayValues> values, std::size_t count) override {
    skipUpTo(header_.vertexElement);
    const std::uint64_t left = header_.vertices().count - done_;
    const auto step = static_cast<std::size_t>(std::min<std::uint64_t>(count, left));
    body_->readVertices(done_, step, positions, values);
    done_ += step;
    if (step < count) finish();
    return step;
  }

 private:
  void keepLines(const char* key, const std::vector<std::string>& lines) {
    if (lines.empty()) return;
    std::string text;
    for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + utf8(line);
    info_.metadata.entries.emplace_back(key, std::move(text));
  }

  void skipUpTo(std::size_t element) {
    for (; element_ < element; ++element_) {
      if (element_ == header_.vertexElement) continue;
      const PlyElement& passed = header_.elements[element_];
      const std::optional<std::size_t> faces = plyFaceList(passed);
      if (keepsMesh_ && faces) {
        body_->readLists(passed, *faces, mesh_.faces);
      } else {
        body_->skip(passed);
      }
    }
  }

  void finish() {
    if (finished_) return;
    skipUpTo(header_.elements.size());
    body_->requireEnd();
    finished_ = true;
  }

  InputBuffer in_;
  TextScanner text_;
  PlyHeader header_;
  std::unique_ptr<PlyBody> body_;
  /// The next element to pass over.
  std::size_t element_ = 0;
  std::uint64_t done_ = 0;
  bool finished_ = false;
};

}  // namespace

std::unique_ptr<PointStream> openPly(InputBuffer in) {
  return std::make_unique<PlyStream>(std::move(in));
}

}  // namespace bspc::formats
