// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/spoiled_subject.hpp"

#include <glidar/verify/cases.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>
#include <variant>

namespace glidar::testing {
namespace {

// Every row of verify() fails for errors of its own kind.

class VerifyMutations : public SpecialCases {};

/// An error of one column.
struct ColumnError {
  const char* name;
  void (*spoil)(Hits&);
};

/// A relative error of 1e-5 of the numbers of a column.
template <auto kColumn>
void stretch(Hits& hits) {
  for (auto& value : hits.*kColumn) value *= 1.00001F;
}

const ColumnError kColumnErrors[] = {
    {"range", shift_ranges},
    {"triangle", swap_triangles},
    {"one lost hit", lose_one_hit},
    {"normal",
     [](Hits& hits) {
       for (auto& n : hits.normal) n.x() += 1e-5F;
     }},
    {"depth", stretch<&Hits::depth_m>},
    {"cosine",
     [](Hits& hits) {
       for (float& c : hits.cos_incidence) c *= 0.9F;
     }},
    {"shading cosine",
     [](Hits& hits) {
       for (float& c : hits.cos_shading) c *= 0.9F;
     }},
    {"shading normal", stretch<&Hits::shading_normal>},
    {"barycentrics",
     [](Hits& hits) {
       for (auto& b : hits.barycentrics) b.y() += 0.01F;
     }},
    {"point",
     [](Hits& hits) {
       for (auto& p : hits.object_point_m) p.y() += 1e-6;
     }},
};

TEST_F(VerifyMutations, AnErrorOfAnyColumnIsDetectedInEveryStaticRow) {
  for (const ColumnError& error : kColumnErrors) {
    const VerifyCase rest = make_cases(0, 1.0)[0];
    EXPECT_FALSE(run_case(rest, shapes()[0], subject("rays", error.spoil)).passed()) << error.name;
    for (const char* name : {"scanner among bodies", "at vertices and edges", "1,000 instances",
                             "209,088 triangles", "culled back faces", "lidar equation"}) {
      EXPECT_FALSE(named(name).run(subject("rays", error.spoil)).passed())
          << error.name << ", " << name;
    }
  }
}

/// An error that only one row can find.
struct RowError {
  const char* row;
  Spoiled::Spoil spoil;
};

void add_half_a_metre(Hits& hits, const std::function<bool(std::size_t)>& is_wrong) {
  for (std::size_t i = 0; i < hits.range_m.size(); ++i)
    if (hits.instance[i] != kInvalidId && is_wrong(i)) hits.range_m[i] += 0.5;
}

TEST_F(VerifyMutations, ErrorsOfLargeCastsAndScenesAreDetected) {
  const std::vector<RowError> errors = {
      {"several tiles",
       [](const CastRequest& request, Hits& hits) {
         add_half_a_metre(hits, [&](std::size_t) { return request.beams.size() > 100'000; });
       }},
      {"several tiles",
       [](const CastRequest&, Hits& hits) {
         add_half_a_metre(hits, [](std::size_t i) { return i > 100'000; });
       }},
      {"1,000 instances",
       [](const CastRequest&, Hits& hits) {
         add_half_a_metre(hits, [&](std::size_t i) { return hits.instance[i] >= 990; });
       }},
      {"209,088 triangles",
       [](const CastRequest&, Hits& hits) {
         add_half_a_metre(hits, [&](std::size_t i) { return hits.primitive[i] >= 200'000; });
       }},
      {"culled back faces",
       [](const CastRequest& request, Hits& hits) {
         add_half_a_metre(hits, [&](std::size_t) { return request.cull_back_faces; });
       }},
  };
  for (const RowError& error : errors) {
    for (const char* kind : {"rays", "raster"}) {
      EXPECT_TRUE(named(error.row).run(subject(kind)).passed()) << error.row << ", " << kind;
      EXPECT_FALSE(named(error.row).run(spoiled_subject(kind, error.spoil)).passed())
          << error.row << ", " << kind;
    }
  }
}

TEST_F(VerifyMutations, FacesThatAreCulledFromTheWrongSideAreDetected) {
  VerifySubject wrong = subject("rays");
  wrong.make = [](const Scene& scene) {
    class Uncut final : public Renderer {
     public:
      explicit Uncut(std::unique_ptr<Renderer> inner) : inner_(std::move(inner)) {}
      [[nodiscard]] std::string_view name() const override { return inner_->name(); }
      [[nodiscard]] ThreadPool& thread_pool() override { return inner_->thread_pool(); }
      void cast(const CastRequest& request, Hits& hits) override {
        CastRequest all = request;
        all.cull_back_faces = false;
        inner_->cast(all, hits);
      }

     private:
      std::unique_ptr<Renderer> inner_;
    };
    return std::make_unique<Uncut>(make_renderer(scene, {.kind = "rays", .threads = 2}));
  };
  EXPECT_GT(named("culled back faces").run(wrong).wrong_ids, 100U);
}

/// A subject whose measured frames are spoiled.
VerifySubject measuring(const std::function<void(Frame&)>& spoil) {
  VerifySubject wrong = subject("rays");
  wrong.measure = [=](Simulator& simulator, const Motion& motion, Frame& frame) {
    measure_frame(simulator, motion, frame);
    spoil(frame);
  };
  return wrong;
}

template <class Column>
void add_to_all(Column& column, double error) {
  for (auto& value : column) value = static_cast<std::decay_t<decltype(value)>>(value + error);
}

TEST_F(VerifyMutations, ErrorsOfMeasurementsAreDetected) {
  struct MeasurementError {
    const char* row;
    void (*spoil)(Frame&);
  };
  const MeasurementError errors[] = {
      {"lidar equation",
       [](Frame& f) {
         for (float& i : f.intensity) i *= 1.00001F;
       }},
      {"lidar equation", [](Frame& f) { add_to_all(f.range_m, 1e-9); }},
      {"lidar equation", [](Frame& f) { add_to_all(f.ground_truth.noise_scale, 0.01); }},
      {"lidar equation", [](Frame& f) { add_to_all(f.ground_truth.diffuse, 0.01); }},
      {"lidar equation",
       [](Frame& f) { std::ranges::replace(f.status, Status::below_threshold, Status::hit); }},
      {"footprint",
       [](Frame& f) {
         for (float& i : f.intensity) i *= 1.03F;
       }},
      {"footprint", [](Frame& f) { add_to_all(f.range_m, 0.01); }},
      {"footprint", [](Frame& f) { f.status[f.status.size() / 4] = Status::miss; }},
      {"measured motion", [](Frame& f) { add_to_all(f.true_radial_velocity_m_s, 1e-9); }},
      {"measured motion", [](Frame& f) { add_to_all(f.radial_velocity_m_s, 1e-9); }},
      {"measured motion", [](Frame& f) { f.beam_poses.world_from_sensor.back()[1] += 1e-9; }},
      {"measured motion",
       [](Frame& f) {
         for (auto& pose : f.beam_poses.world_from_object) pose[4] += 1e-9;
       }},
      {"measured motion", [](Frame& f) { f.deskewed.directions.back().x() += 1e-9; }},
      {"measured motion", [](Frame& f) { f.deskewed.origins_m.back().z() += 1e-9; }},
      {"measured motion", [](Frame& f) { add_to_all(f.ground_truth.range_m, 1e-4); }},
  };
  for (const MeasurementError& error : errors) {
    EXPECT_TRUE(named(error.row).run(subject("rays")).passed()) << error.row;
    EXPECT_FALSE(named(error.row).run(measuring(error.spoil)).passed())
        << error.row << ", error " << &error - errors;
  }
}

TEST_F(VerifyMutations, RaysBesideTheirPixelsAreDetected) {
  for (const SpecialCase& c : all()) {
    if (c.name != "lens") continue;
    EXPECT_TRUE(c.run(subject("rays")).passed()) << c.shape;
    VerifySubject wrong = subject("rays");
    wrong.beams_of_camera = [](const Pinhole& camera) {
      Beams beams = camera_beams(camera);
      for (Eigen::Vector3d& d : beams.directions)
        d = (d + Eigen::Vector3d(1e-9, 0.0, 0.0)).normalized();
      return beams;
    };
    EXPECT_FALSE(c.run(wrong).passed()) << c.shape;
    wrong.beams_of_camera = [](Pinhole camera) {
      if (auto* lens = std::get_if<RadialTangential>(&camera.distortion)) lens->max_radius = 2.0;
      if (auto* lens = std::get_if<Fisheye>(&camera.distortion)) lens->k4 += 1e-4;
      return camera_beams(camera);
    };
    EXPECT_GT(c.run(wrong).wrong(), 0U) << c.shape;
  }
}

}  // namespace
}  // namespace glidar::testing
