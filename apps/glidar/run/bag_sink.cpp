// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/bag_sink.hpp>

#include <glidar/io/bags/bag.hpp>

namespace glidar::app {
namespace {

class BagSink final : public FrameSink {
 public:
  BagSink(const std::string& path, const RenderFlags& flags, const PreparedScene& prepared,
          PoseOrigin origin)
      : path_(path),
        bag_(bags::create_bag(path)),
        publisher_(make_rig_publisher(*bag_, flags, prepared, origin)) {}

  [[nodiscard]] HitColumnMask hit_columns(std::size_t sensor_index) const override {
    return publisher_->hit_columns(sensor_index);
  }
  void write(const MeasuredFrame& measured) override {
    publisher_->publish(measured.sensor_index, measured.frame, *measured.beams);
  }
  void finish() override {
    publisher_->finish();
    bag_->finish();
  }
  [[nodiscard]] std::vector<std::filesystem::path> files() const override { return {path_}; }

 private:
  std::string path_;
  std::unique_ptr<bags::BagWriter> bag_;
  std::unique_ptr<ros::RigPublisher> publisher_;
};

}  // namespace

std::unique_ptr<FrameSink> make_bag_sink(const std::string& path, const RenderFlags& flags,
                                         const PreparedScene& prepared, PoseOrigin origin) {
  return std::make_unique<BagSink>(path, flags, prepared, origin);
}

}  // namespace glidar::app
