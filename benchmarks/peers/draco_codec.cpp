#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/point_cloud/point_cloud.h>

#include <cstring>
#include <memory>
#include <stdexcept>
#include <utility>

#include "codec.h"

namespace bspc::bench {

namespace {

Bytes encodeWithDraco(const Coordinates& xyz, DracoMethod method, int speed) {
  const std::size_t count = xyz.size() / 3;
  draco::PointCloud cloud;
  cloud.set_num_points(static_cast<std::uint32_t>(count));
  draco::GeometryAttribute position;
  position.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_INT32, false,
                3 * sizeof(std::int32_t), 0);
  const int id = cloud.AddAttribute(position, true, static_cast<std::uint32_t>(count));
  std::memcpy(cloud.attribute(id)->buffer()->data(), xyz.data(), xyz.size() * sizeof(xyz[0]));
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method == DracoMethod::KdTree ? draco::POINT_CLOUD_KD_TREE_ENCODING
                                                          : draco::POINT_CLOUD_SEQUENTIAL_ENCODING);
  encoder.SetSpeedOptions(speed, speed);
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodePointCloudToBuffer(cloud, &buffer);
  if (!status.ok()) throw std::runtime_error("Draco: " + status.error_msg_string());
  return {buffer.data(), buffer.data() + buffer.size()};
}

Coordinates decodeWithDraco(const Bytes& bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  auto result = decoder.DecodePointCloudFromBuffer(&buffer);
  if (!result.ok()) throw std::runtime_error("Draco: " + result.status().error_msg_string());
  const std::unique_ptr<draco::PointCloud> cloud = std::move(result).value();
  const auto* position = cloud->GetNamedAttribute(draco::GeometryAttribute::POSITION);
  Coordinates xyz(3 * std::size_t{cloud->num_points()});
  for (std::uint32_t i = 0; i < cloud->num_points(); ++i) {
    position->GetMappedValue(draco::PointIndex(i), &xyz[3 * std::size_t{i}]);
  }
  return xyz;
}

}  // namespace

Codec dracoCodec(DracoMethod method, int speed) {
  Codec codec;
  codec.name = std::string("Draco ") + (method == DracoMethod::KdTree ? "kd-tree" : "sequential") +
               " speed " + std::to_string(speed);
  codec.encode = [method, speed](const Coordinates& xyz, unsigned /*threads*/) {
    return encodeWithDraco(xyz, method, speed);
  };
  codec.decode = [](const Bytes& bytes, unsigned /*threads*/) { return decodeWithDraco(bytes); };
  return codec;
}

}  // namespace bspc::bench
