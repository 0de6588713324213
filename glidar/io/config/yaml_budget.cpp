// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/yaml_budget.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/input_budget.hpp>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <cstddef>
#include <sstream>
#include <utility>
#include <vector>

namespace glidar {
namespace {

constexpr std::size_t kMaxValues = 1'000'000;
constexpr std::size_t kMaxDocuments = 100;  // yaml-cpp reads endless ones after some invalid bytes

/// Counts values as the parser meets them, without keeping any.
class Counter : public YAML::EventHandler {
 public:
  Counter(const std::string& file, std::size_t bytes) : file_(file), budget_(bytes) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ > kMaxDocuments) fail(mark, "more than 100 YAML documents", "one", "");
    sizes_.clear();
    open_.clear();
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add_plain(mark, anchor); }
  void OnScalar(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                const std::string& /*value*/) override {
    add_plain(mark, anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const std::size_t size = anchor < sizes_.size() ? sizes_[anchor] : 0;
    if (size == 0) fail(mark, "an alias of the value that it is in", "aliases of other values", "");
    add(mark, size);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    begin(mark, anchor);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    begin(mark, anchor);
  }
  void OnMapEnd() override { end(); }

 private:
  void add(const YAML::Mark& mark, std::size_t count) {
    if (!budget_.try_take(Budget::values, count)) {
      fail(mark,
           "more than " + std::to_string(budget_.limit(Budget::values)) +
               " values with aliases written out",
           "1000000 values and 2 more for each byte of the file",
           "use fewer aliases, or smaller ones");
    }
    written_out_ += count;
  }
  void build(const YAML::Mark& mark) {
    if (++built_ > kMaxValues) fail(mark, "more than 1000000 values", "fewer", "use aliases");
    add(mark, 1);
  }
  void add_plain(const YAML::Mark& mark, YAML::anchor_t anchor) {
    build(mark);
    keep(anchor, 1);
  }
  void begin(const YAML::Mark& mark, YAML::anchor_t anchor) {
    open_.emplace_back(anchor, written_out_);
    build(mark);
    keep(anchor, 0);
  }
  void end() {
    const auto [anchor, before] = open_.back();
    open_.pop_back();
    keep(anchor, written_out_ - before);
  }
  /// The size of what has this anchor; 0: it is not at its end yet.
  void keep(YAML::anchor_t anchor, std::size_t size) {
    if (anchor == 0) return;
    if (sizes_.size() <= anchor) sizes_.resize(anchor + 1);
    sizes_[anchor] = size;
  }
  [[noreturn]] void fail(const YAML::Mark& mark, std::string found, std::string allowed,
                         std::string remedy) const {
    const std::string where =
        file_ + ":" + std::to_string(mark.line + 1) + ":" + std::to_string(mark.column + 1);
    throw Error({where, std::move(found), std::move(allowed), std::move(remedy)});
  }

  const std::string& file_;
  InputBudget budget_;
  std::size_t documents_ = 0;
  std::size_t built_ = 0;
  std::size_t written_out_ = 0;
  std::vector<std::size_t> sizes_;                            ///< by anchor
  std::vector<std::pair<YAML::anchor_t, std::size_t>> open_;  ///< anchor, values before it
};

}  // namespace

void check_yaml_budget(const std::string& file, const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  Counter counter(file, text.size());
  while (parser.HandleNextDocument(counter)) {
  }
}

}  // namespace glidar
