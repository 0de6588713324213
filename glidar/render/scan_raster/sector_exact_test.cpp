// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/scan_raster/sector_exact_test.hpp>

#include <glidar/render/common/rounding.hpp>
#include <glidar/render/rays/exact_test.hpp>

#include <bit>
#include <cmath>

namespace glidar::scan_raster {

void SectorExactTest::set_instance(std::uint32_t instance, Placement& placement) {
  instance_ = instance;
  compared_ = kNoSlotNumber;
  placement.first_number = slots_.first_number(instance);
  placement.always_retests = cast_.request.cull_back_faces || cast_.resolver.is_masked(instance);
  placement.context = this;
  placement.retest_exactly = [](void* self, std::uint32_t cell, std::uint32_t slot) {
    static_cast<SectorExactTest*>(self)->retest_exactly(cell, slot);
  };
  packet_.tie_reach = cast_.trees.max_reach_m() / placement.metres;
  packet_.context = this;
  packet_.accepts_hit = nullptr;
  if (!placement.always_retests) return;
  packet_.accepts_hit = [](const void* context, unsigned, std::uint32_t primitive) {
    const auto& self = *static_cast<const SectorExactTest*>(context);
    return glidar::blocks_beam(self.cast_.resolver, self.cast_.request.beams, self.beam_,
                               self.cast_.request.cull_back_faces, {self.instance_, primitive});
  };
}

std::uint32_t SectorExactTest::number_at(std::uint32_t cell) const {
  return std::bit_cast<std::uint32_t>(buffer_.number[cell]);
}

void SectorExactTest::defer_to_rays(std::uint32_t cell) {
  buffer_.low[cell] = -1.0F;
  buffer_.high[cell] = -1.0F;
  buffer_.number[cell] = std::bit_cast<float>(kNoSlotNumber);
  deferred_beams_.push_back(sector_.beam(cell));
}

/// Compares the triangle with the nearest one so far if that is of the same instance.
void SectorExactTest::trace(std::uint32_t cell, std::uint32_t slot) {
  const InstanceView& view = cast_.resolver.view(instance_);
  const ObjectRay ray = ray_in(view, cast_.request.beams, beam_);
  rays::set_ray(packet_, 0, ray.origin, ray.direction);
  packet_.prepared = 0;
  packet_.known = 0;
  packet_.tied = 0;
  packet_.slot[0] = rays::kNoTriangle;
  const std::uint32_t number = number_at(cell);
  if (number != kNoSlotNumber && slots_.instance_of(number) == instance_) {
    packet_.slot[0] = number - slots_.first_number(instance_);
    packet_.low[0] = well_below(double{buffer_.low[cell]} / view.scale);
    packet_.high[0] = well_above(double{buffer_.high[cell]} / view.scale);
  }
  rays::retest_exactly(cast_.trees.of_instance(instance_).blocks.data(), packet_, 0, slot);
}

/// Compares with the nearest triangle so far if that is of another instance.
bool SectorExactTest::is_first(std::uint32_t cell, const PrimitiveRef& found, double low_m,
                               double high_m) {
  const PrimitiveRef before = slots_.decode(number_at(cell));
  if (before.instance == kInvalidId || before.instance == found.instance) return true;
  if (low_m > double{buffer_.high[cell]}) return false;
  if (high_m < double{buffer_.low[cell]}) return true;
  const rays::HitOrder order = rays::order_of_hits(cast_, beam_, found, before);
  if (order.ties) packet_.tied = 1;
  return order.is_nearer;
}

/// True where the triangle has the same corners as the cell's nearest one; the lower one is kept.
/// The last comparison is cached, since cells of a row mostly compare the same two.
bool SectorExactTest::is_coincident(std::uint32_t cell, std::uint32_t slot) {
  const std::uint32_t number = number_at(cell);
  if (number == kNoSlotNumber || packet_.accepts_hit != nullptr) return false;
  if (number != compared_ || slot != compared_slot_) {
    compared_ = number;
    compared_slot_ = slot;
    const std::uint32_t before = number - slots_.first_number(instance_);
    const TriangleBlock* blocks = cast_.trees.of_instance(instance_).blocks.data();
    is_same_ =
        slots_.instance_of(number) == instance_ && rays::have_same_corners(blocks, before, slot);
    const std::uint32_t other = slots_.first_number(instance_) + slot;
    lower_ = is_same_ && slots_.decode(other).primitive < slots_.decode(number).primitive ? other
                                                                                          : number;
  }
  if (is_same_) buffer_.number[cell] = std::bit_cast<float>(lower_);
  return is_same_;
}

void SectorExactTest::retest_exactly(std::uint32_t cell, std::uint32_t slot) {
  if (buffer_.high[cell] < 0.0F || is_coincident(cell, slot)) return;
  beam_ = sector_.beam(cell);
  trace(cell, slot);
  const bool is_hit = packet_.slot[0] == slot;
  const double scale = cast_.resolver.view(instance_).scale;
  const double low_m = scale * double{packet_.low[0]};
  const double high_m = scale * double{packet_.high[0]};
  const std::uint32_t number = slots_.first_number(instance_) + slot;
  const bool is_nearest = is_hit && is_first(cell, slots_.decode(number), low_m, high_m);
  if (packet_.tied != 0) return defer_to_rays(cell);
  if (!is_nearest) return;
  buffer_.low[cell] = well_below(low_m);
  buffer_.high[cell] = well_above(high_m);
  buffer_.number[cell] = std::bit_cast<float>(number);
}

}  // namespace glidar::scan_raster
