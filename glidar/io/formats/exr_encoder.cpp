// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/exr_encoder.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/version.hpp>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <fmt/format.h>

#include <cstddef>
#include <limits>
#include <stdexcept>

namespace glidar {
namespace {

/// OpenEXR seeks back to write the offsets of its blocks.
class MemoryStream : public Imf::OStream {
 public:
  MemoryStream() : OStream("memory") {}

  void write(const char* from, int size) override {
    const std::size_t end = position_ + static_cast<std::size_t>(size);
    if (bytes_.size() < end) bytes_.resize(end);
    bytes_.replace(position_, static_cast<std::size_t>(size), from, static_cast<std::size_t>(size));
    position_ = end;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
  std::size_t position_ = 0;
};

Imf::PixelType pixel_type(const ExrChannel& channel) {
  return std::holds_alternative<std::vector<float>>(channel.pixels) ? Imf::FLOAT : Imf::UINT;
}

int side(std::uint32_t pixels) {
  if (pixels > 0 && pixels <= static_cast<std::uint32_t>(std::numeric_limits<int>::max()))
    return static_cast<int>(pixels);
  throw std::invalid_argument(fmt::format("a side of {} pixels", pixels));
}

Imf::Header header_of(const ExrImage& image) {
  Imf::Header header(side(image.cols), side(image.rows), 1.0F, {0.0F, 0.0F}, 1.0F,
                     Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
  Imf::addComments(header, image.comments);
  header.insert("software", Imf::StringAttribute(fmt::format("glidar {}", version())));
  for (const ExrChannel& channel : image.channels)
    header.channels().insert(channel.name, Imf::Channel(pixel_type(channel)));
  return header;
}

/// OpenEXR's frame buffers have mutable pixels, which it only reads here.
Imf::FrameBuffer frame_buffer_of(const ExrImage& image) {
  constexpr std::size_t kPixelBytes = 4;
  Imf::FrameBuffer buffer;
  for (const ExrChannel& channel : image.channels) {
    const auto* bytes =
        std::visit([](const auto& pixels) { return reinterpret_cast<const char*>(pixels.data()); },
                   channel.pixels);
    buffer.insert(channel.name, Imf::Slice(pixel_type(channel), const_cast<char*>(bytes),
                                           kPixelBytes, kPixelBytes * image.cols));
  }
  return buffer;
}

}  // namespace

bool has_openexr() {
  return true;
}

std::string encode_exr(const ExrImage& image, const std::filesystem::path& path) {
  MemoryStream stream;
  try {
    constexpr int kNoFurtherThreads = 0;
    Imf::OutputFile file(stream, header_of(image), kNoFurtherThreads);
    file.setFrameBuffer(frame_buffer_of(image));
    file.writePixels(static_cast<int>(image.rows));
  } catch (const std::exception& error) {
    throw Error({path.string(), fmt::format("OpenEXR cannot write the image: {}", error.what()), "",
                 "write .npz, which has the same columns"});
  }
  return stream.take();
}

}  // namespace glidar
