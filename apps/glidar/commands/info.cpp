// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/commands.hpp>
#include <apps/glidar/options/render_options.hpp>
#include <apps/glidar/run/advice.hpp>
#include <apps/glidar/run/console.hpp>
#include <apps/glidar/run/exit_code.hpp>
#include <apps/glidar/run/printing.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/model/model_parts.hpp>
#include <glidar/io/model/model_report.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <nlohmann/json.hpp>

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glidar::app {
namespace {

constexpr const char* kInfoExamples = R"(Examples:
  glidar info builtin:asteroid
  glidar info builtin:torus --json
With your own files:
  glidar info satellite.obj --parts
  glidar info part.stl --unit mm --up y

Exit codes: 0 done (also for models with defects), 2 the model cannot be read.)";

struct InfoFlags {
  std::string input;
  ModelOptions model;
  bool json = false;
  bool parts = false;
};

void line(std::string_view name, const std::string& value) {
  constexpr std::size_t kMaxLine_bytes = 1000;
  print("{:<14} {}\n", name, excerpt(value, kMaxLine_bytes));
}

std::string vector_text(const Eigen::Vector3d& v, std::string_view separator) {
  return fmt::format("{1:.6g}{0}{2:.6g}{0}{3:.6g}", separator, v.x(), v.y(), v.z());
}

/// "1 open edges, 2 degenerate triangles": the defects with their counts.
std::string defect_text(const MeshCheck& check) {
  const std::vector<std::pair<std::uint64_t, const char*>> defects = {
      {check.open_edges, "open edges"},
      {check.crowded_edges, "edges of more than two triangles"},
      {check.inconsistent_edges, "edges with opposite windings"},
      {check.degenerate_triangles, "degenerate triangles"},
      {check.duplicate_triangles, "duplicate triangles"},
      {check.duplicate_vertices, "duplicate vertices"},
      {check.unused_vertices, "unused vertices"},
  };
  std::string text;
  for (const auto& [count, name] : defects) {
    if (count == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name);
  }
  return text.empty() ? "none" : text;
}

std::string texture_text(const MaterialSummary& material) {
  std::string text;
  const auto add = [&](const char* use, const std::string& name) {
    if (!name.empty()) text += fmt::format(", {} {}", use, name);
  };
  add("diffuse", material.diffuse_texture);
  add("specular", material.specular_texture);
  add("normal", material.normal_texture);
  add("alpha", material.alpha_texture);
  return material.cut_out ? text + ", cut-out" : text;
}

void print_lists(const ModelReport& report) {
  constexpr std::size_t kMax = 50;  // lines of one kind; --json lists all
  const auto list = [&](std::string_view name, const auto& entries, const auto& text) {
    for (std::size_t i = 0; i < entries.size() && i < kMax; ++i) line(name, text(entries[i]));
    if (entries.size() > kMax) {
      line(name, fmt::format("... and {} more (--json lists all)", entries.size() - kMax));
    }
  };
  list("mesh", report.parts, [](const ModelPart& part) {
    return fmt::format("{}: {} triangles", part.name.empty() ? "(no name)" : part.name,
                       part.triangle_count);
  });
  list("material", report.materials, [](const MaterialSummary& material) {
    return fmt::format("{}: {} triangles, reflectance {:.4g}{}", material.name, material.triangles,
                       material.reflectance, texture_text(material));
  });
  list("texture", report.textures, [](const TextureSummary& texture) {
    return fmt::format("{}: {} x {}, {} channels", texture.name, texture.width, texture.height,
                       texture.channels);
  });
  list("MISSING", report.missing_textures, [](const MissingTexture& texture) {
    return fmt::format("texture {}: {}", texture.name, texture.reason);
  });
  list("note", report.notes, [](const std::string& note) { return note; });
}

std::string count_text(const std::optional<std::uint64_t>& count) {
  return count ? fmt::format("{}", *count) : "-";
}

std::string box_text(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return "-";
  return vector_text(box.min(), ", ") + " to " + vector_text(box.max(), ", ");
}

/// What the file states next to what was loaded, in the file's own units and axes.
void print_content(const ModelContent& stated, const ModelContent& loaded) {
  if (!stated.vertices && !stated.faces && stated.bounds.isEmpty()) return;
  const auto both = [](const char* what, const std::string& of_file, const std::string& of_model) {
    line("content", fmt::format("{}: {} stated, {} loaded", what, of_file, of_model));
  };
  both("vertices", count_text(stated.vertices), count_text(loaded.vertices));
  both("faces", count_text(stated.faces), count_text(loaded.faces));
  if (stated.instances) {
    both("instances", count_text(stated.instances), count_text(loaded.instances));
  }
  both("bounds", box_text(stated.bounds), box_text(loaded.bounds));
  const std::string difference = content_difference(stated, loaded);
  if (!difference.empty()) line("DIFFERENT", difference);
}

void print_table(const ModelReport& report, const std::string& up_hint) {
  line("model", report.source + (report.from_cache ? " (from the cache)" : ""));
  line("format", report.format);
  if (!report.hash.empty()) line("hash", report.hash);
  line("triangles", fmt::format("{}", report.triangles));
  line("vertices", fmt::format("{}", report.vertices));
  line("size", vector_text(report.size_m, " x ") + " m");
  line("from", vector_text(report.min_m, ", ") + " m");
  line("to", vector_text(report.max_m, ", ") + " m");
  line("unit", report.unit_guess);
  line("up", report.up + (up_hint.empty() ? "" : "; " + up_hint));
  line("surface", fmt::format("{}, winding {}, area {:.6g} m2", report.closed ? "closed" : "open",
                              to_string(report.winding), report.check.area_m2));
  line("defects", defect_text(report.check));
  print_content(report.stated, report.loaded);
  print_lists(report);
}

using Json = nlohmann::ordered_json;

Json json_of(const Eigen::Vector3d& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

Json json_of(const MeshCheck& check) {
  return {{"area_m2", check.area_m2},
          {"signed_volume_m3", check.signed_volume_m3},
          {"open_edges", check.open_edges},
          {"crowded_edges", check.crowded_edges},
          {"inconsistent_edges", check.inconsistent_edges},
          {"degenerate_triangles", check.degenerate_triangles},
          {"duplicate_triangles", check.duplicate_triangles},
          {"duplicate_vertices", check.duplicate_vertices},
          {"unused_vertices", check.unused_vertices}};
}

Json json_of(const ModelContent& content) {
  const auto count = [](const std::optional<std::uint64_t>& n) { return n ? Json(*n) : Json(); };
  const bool has_box = !content.bounds.isEmpty();
  return {{"vertices", count(content.vertices)},
          {"faces", count(content.faces)},
          {"instances", count(content.instances)},
          {"min", has_box ? json_of(Eigen::Vector3d(content.bounds.min())) : Json()},
          {"max", has_box ? json_of(Eigen::Vector3d(content.bounds.max())) : Json()}};
}

/// An array with an object for each entry.
template <typename Entry, typename Function>
Json json_list(const std::vector<Entry>& entries, const Function& object) {
  Json list = Json::array();
  for (const Entry& entry : entries) list.push_back(object(entry));
  return list;
}

Json json_of(const ModelReport& report, const std::string& up_hint) {
  Json json = {{"source", report.source},
               {"format", report.format},
               {"hash", report.hash},
               {"from_cache", report.from_cache},
               {"triangles", report.triangles},
               {"vertices", report.vertices},
               {"min_m", json_of(report.min_m)},
               {"max_m", json_of(report.max_m)},
               {"size_m", json_of(report.size_m)},
               {"metres_per_unit", report.metres_per_unit},
               {"unit_declared", report.unit_declared ? Json(*report.unit_declared) : Json()},
               {"unit_guess", report.unit_guess},
               {"up", report.up},
               {"up_guess", up_hint},
               {"closed", report.closed},
               {"winding", to_string(report.winding)},
               {"check", json_of(report.check)}};
  json["meshes"] = json_list(report.parts, [](const ModelPart& part) -> Json {
    return {{"name", part.name},
            {"first_triangle", part.first_triangle},
            {"triangles", part.triangle_count}};
  });
  json["materials"] = json_list(report.materials, [](const MaterialSummary& m) -> Json {
    return {{"name", m.name},
            {"triangles", m.triangles},
            {"reflectance", m.reflectance},
            {"diffuse_texture", m.diffuse_texture},
            {"specular_texture", m.specular_texture},
            {"normal_texture", m.normal_texture},
            {"alpha_texture", m.alpha_texture},
            {"cut_out", m.cut_out}};
  });
  json["textures"] = json_list(report.textures, [](const TextureSummary& t) -> Json {
    return {{"name", t.name}, {"width", t.width}, {"height", t.height}, {"channels", t.channels}};
  });
  json["missing_textures"] =
      json_list(report.missing_textures, [](const MissingTexture& t) -> Json {
        return {{"name", t.name}, {"reason", t.reason}};
      });
  json["stated"] = json_of(report.stated);
  json["loaded"] = json_of(report.loaded);
  json["notes"] = report.notes;
  return json;
}

void print_parts(const std::vector<PartSummary>& parts) {
  if (parts.empty()) return line("parts", "none with a name; materials are parts too");
  for (const PartSummary& part : parts) {
    std::string materials;
    for (const std::string& name : part.materials) {
      materials += (materials.empty() ? "" : ", ") + name;
    }
    const PoseVector pose = to_xyz_wxyz(part.parent_from_part);
    line(part.name, fmt::format("{} triangles, {}, from {} m", part.triangles, materials,
                                box_text(part.box_m)));
    line("", fmt::format("in {}: position [{}], orientation {{w: {:.6g}, x: {:.6g}, y: {:.6g}, "
                         "z: {:.6g}}}",
                         part.parent.empty() ? "the file" : part.parent,
                         vector_text(pose.head<3>(), ", "), pose[3], pose[4], pose[5], pose[6]));
  }
}

Json json_of(const std::vector<PartSummary>& parts) {
  return json_list(parts, [](const PartSummary& part) -> Json {
    const PoseVector pose = to_xyz_wxyz(part.parent_from_part);
    return {{"name", part.name},
            {"parent", part.parent},
            {"materials", part.materials},
            {"triangles", part.triangles},
            {"min_m", json_of(Eigen::Vector3d(part.box_m.min()))},
            {"max_m", json_of(Eigen::Vector3d(part.box_m.max()))},
            {"pose",
             {{"position", json_of(Eigen::Vector3d(pose.head<3>()))},
              {"orientation", {{"w", pose[3]}, {"x", pose[4]}, {"y", pose[5]}, {"z", pose[6]}}}}}};
  });
}

/// Loads the model; the console shows the progress.
Model load(const InfoFlags& flags, Console& console) {
  const ProgressScope progress(console, "reading " + flags.input);
  Report report_to_console = console.report();
  report_to_console.log = [&](Severity severity, std::string_view message) {
    const bool is_in_table = message.starts_with(flags.input + ": ");
    if (severity == Severity::warning && !is_in_table) console.warn(message);
  };
  return load_model(flags.input, flags.model, report_to_console);
}

ModelReport examine(const Model& model, const InfoFlags& flags, Console& console) {
  const ProgressScope progress(console, "examining " + flags.input);
  return inspect(model);
}

int run_info(const InfoFlags& flags) {
  Console console;
  const Model model = load(flags, console);
  if (flags.parts) {
    const std::vector<PartSummary> parts = list_parts(model);
    if (flags.json) {
      print_json(json_of(parts));
    } else {
      print_parts(parts);
    }
    return kDone;
  }
  const ModelReport report = examine(model, flags, console);
  const std::string up_hint =
      flags.model.up ? ""
                     : up_advice(report.format, Eigen::AlignedBox3d(report.min_m, report.max_m));
  if (flags.json) {
    print_json(json_of(report, up_hint));
  } else {
    print_table(report, up_hint);
  }
  return kDone;
}

}  // namespace

Command add_info(CLI::App& program) {
  CLI::App& command = *program.add_subcommand("info", "Report the contents of a model file");
  const auto flags = std::make_shared<InfoFlags>();
  command.footer(kInfoExamples);
  command.add_option("MODEL", flags->input, "Model file or builtin:NAME")
      ->required()
      ->type_name("");
  add_model_options(command, flags->model);
  command.add_flag("--parts", flags->parts,
                   "List the parts that scene files can change by the key parts");
  command.add_flag("--json", flags->json, "Print JSON instead of a table");
  return [flags] { return run_info(*flags); };
}

}  // namespace glidar::app
