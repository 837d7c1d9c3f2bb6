#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bspc/arrays.h"
#include "bspc/mesh.h"
#include "bspc/point_set.h"
#include "bspc/stream_encoder.h"
#include "cli/array_choice.h"
#include "cli/input_file.h"
#include "formats/model_io.h"

namespace bspc::cli {

/// The format that `name` spells ("ply", …), or that the ending of `path` says if `name` is empty.
/// Both throw UsageError if neither tells.
formats::Format chooseInputFormat(const std::string& name, const std::string& path);
formats::Format chooseOutputFormat(const std::string& name, const std::string& path);

/// What of a model file is wanted, by the user's word; the rest may be left out.
struct ContentArguments {
  ArrayArguments arrays;
  bool positionsOnly = false;
  bool noFaces = false;
  bool dropOther = false;
  std::string crs;
};

/// Reads a whole model file with everything that a .bspc file can hold. Messages name the file.
formats::Model readModelFile(const std::string& path, const std::string& formatName,
                             const ProgressCallback& progress);

/// The points and arrays of a model file for an encoder, in pieces. What a .bspc file cannot hold
/// is refused by Error(Unsupported), at the end of the file if it is known only there, unless it is
/// said that it may be left out.
class ModelPoints final : public PointReader {
 public:
  /// `content` must outlive this. Throws UsageError for arrays that the model does not have.
  ModelPoints(const std::string& path, const std::string& formatName,
              const ContentArguments& content, const ProgressCallback& progress);

  ScalarType type() const override { return stream_->info().type; }
  const std::vector<ArrayDescription>& arrays() const override { return arrays_; }
  std::size_t read(std::uint8_t* xyz, Span<ArrayValues> values, std::size_t count) override;
  std::uint64_t expected() const override { return stream_->reservable(); }

  const formats::ModelInfo& info() const { return stream_->info(); }
  /// What is to be stored beside points and arrays.
  Metadata metadata() const;
  bool ended() const { return ended_; }
  /// Whether there may be cells that are to be stored, and these, once all points have been read.
  bool mayHaveMesh() const { return keepsMesh_ && stream_->mayHaveMesh(); }
  MeshCells takeMesh() { return stream_->takeMesh(); }

 private:
  void chooseFrom(const std::vector<ArrayDescription>& arrays);
  void refuseOther() const;
  std::size_t readChosen(std::uint8_t* xyz, Span<ArrayValues> values, std::size_t count);

  formats::Format format_;
  InputFile input_;
  const ContentArguments& content_;
  bool keepsMesh_;
  bool ended_ = false;
  std::unique_ptr<formats::PointStream> stream_;
  /// The arrays that are kept, and which of the file's they are.
  std::vector<ArrayDescription> arrays_;
  std::vector<std::size_t> chosen_;
  /// One for each array of the file.
  std::vector<ArrayValues> all_;
};

/// The points of a model file in memory, with the arrays and cells that are wanted of it.
class WholePoints {
 public:
  /// Reads to the end of the model, or the first `most` points alone, which then have no cells.
  explicit WholePoints(ModelPoints& points, std::uint64_t most = UINT64_MAX);

  /// Must not outlive this.
  PointSetView view() const;
  std::uint64_t size() const { return positions_.size() / (3 * scalarSize(type_)); }
  /// Whether the model has more points.
  bool isCut() const { return isCut_; }

 private:
  ScalarType type_;
  std::vector<std::uint8_t> positions_;
  std::vector<ArrayValues> values_;
  MeshCells mesh_;
  bool isCut_ = false;
};

}  // namespace bspc::cli
