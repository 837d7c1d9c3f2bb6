#pragma once

#include <memory>
#include <string>

#include "bspc/stream_encoder.h"
#include "cli/input_file.h"
#include "formats/model_io.h"

namespace bspc::cli {

/// The format that `name` spells ("ply", …), or that the ending of `path` says if `name` is empty.
/// Both throw UsageError if neither tells, the second also if the format is not written.
formats::Format chooseInputFormat(const std::string& name, const std::string& path);
formats::Format chooseOutputFormat(const std::string& name, const std::string& path);

/// Reads a model file. What a .bspc file cannot hold yet is refused by Error(Unsupported), unless
/// `positionsOnly` is the user's word that it may be left out. Messages name the file.
formats::Model readModelFile(const std::string& path, const std::string& formatName,
                             bool positionsOnly, const ProgressCallback& progress);

/// The points of a model file for an encoder, in pieces. Like readModelFile(), it refuses what a
/// .bspc file cannot hold; at the end of the file if it is known only there.
class ModelPoints final : public PointReader {
 public:
  ModelPoints(const std::string& path, const std::string& formatName, bool positionsOnly,
              const ProgressCallback& progress);

  ScalarType type() const override { return stream_->info().type; }
  std::size_t read(std::uint8_t* xyz, Span<ArrayValues> /*values*/, std::size_t count) override;
  std::uint64_t expected() const override { return stream_->reservable(); }

  const formats::ModelInfo& info() const { return stream_->info(); }
  bool ended() const { return ended_; }

 private:
  void refuseOther() const;

  formats::Format format_;
  InputFile input_;
  bool positionsOnly_;
  bool ended_ = false;
  std::unique_ptr<formats::PointStream> stream_;
};

}  // namespace bspc::cli
