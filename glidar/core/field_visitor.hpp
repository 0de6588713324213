// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/error.hpp>
#include <glidar/core/field.hpp>
#include <glidar/core/function_ref.hpp>
#include <glidar/math/lookup_table.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace glidar {

/// Whole numbers from min to max.
struct WholeRule {
  std::uint32_t min = 0;
  std::uint32_t max = 0xFFFFFFFF;
};

/// A list of min_size to max_size numbers.
struct NumberListRule {
  NumberRule number = {};
  std::size_t min_size = 1;
  std::size_t max_size = 1;
  bool takes_one = false;    ///< one number without a list means min_size equal numbers
  bool takes_range = false;  ///< {from: , to: , count: } means equal steps
  std::string allowed = {};  ///< for errors; empty: "a list of ... numbers"
};

/// The case that a nested map has a word: `key: {inner: word}`.
struct KeyCase {
  const char* key = nullptr;
  const char* inner = nullptr;
  const char* word = nullptr;
};

/// Keys of which a map has at most one.
struct KeyChoice {
  std::vector<const char*> keys;
  const char* allowed;            ///< for errors
  const char* missing = nullptr;  ///< error when there is none; null: none is fine
  const char* remedy = nullptr;   ///< of that error
  const char* conflict_remedy = "remove one of them";
  const char* supplier = nullptr;  ///< a key of a file that may have the value, for schemas
  KeyCase none_needed = {};        ///< the case in which none is missing
};

/// Keys that a map may not have in a case.
struct KeyExclusion {
  KeyCase when;
  std::vector<const char*> keys;
  const char* found;  ///< for errors
  const char* allowed;
  const char* remedy;
};

struct KeyNeed {
  const char* key;
  const char* needed;
  const char* allowed;  ///< for errors
  const char* remedy;
};

/// A list whose length a reader decides.
struct ListAccess {
  std::size_t min_size;
  std::size_t max_size;
  const char* allowed;  ///< for errors about the size
  std::size_t size;
  FunctionRef<void(std::size_t)> resize;
};

/// A map by names of the user's own, to which a reader adds entries.
struct NamesAccess {
  std::size_t size;
  FunctionRef<const std::string&(std::size_t)> name;
  FunctionRef<void(const std::string&)> add;
};

/// Keys of a file that describes several sensors. Readers merge them before they read the rest.
enum class FamilyKey : std::uint8_t {
  overrides,  ///< maps of overrides of the document's keys, by names of the user's own
  name,       ///< one of these names
  names       ///< a list of further names
};

/// A word of files for a value.
template <class Value>
struct Named {
  const char* name;
  Value value;
};

/// Is shown every key of a struct by its function describe(struct, visitor). Readers of files,
/// writers and documentation are visitors, so that each key is described once.
class FieldVisitor {
 public:
  enum class Mode : std::uint8_t {
    keys,      ///< collects keys
    read,      ///< sets values that a file has, and checks them
    report,    ///< writes values for sidecar files: all of them, in units of files
    document,  ///< writes values so that a reader gets the same bits
    schema     ///< collects keys, units, bounds and defaults; the struct has default values
  };
  using Describe = FunctionRef<void(FieldVisitor&)>;
  using DescribeAt = FunctionRef<void(std::size_t, FieldVisitor&)>;

  FieldVisitor() = default;
  FieldVisitor(const FieldVisitor&) = delete;
  FieldVisitor& operator=(const FieldVisitor&) = delete;
  virtual ~FieldVisitor() = default;

  [[nodiscard]] virtual Mode mode() const = 0;
  [[nodiscard]] bool is_reading() const { return mode() == Mode::read; }
  [[nodiscard]] bool is_report() const { return mode() == Mode::report; }
  [[nodiscard]] bool is_document() const { return mode() == Mode::document; }
  [[nodiscard]] bool is_writing() const { return is_report() || is_document(); }

  // The action for each kind of value; by default key(field).

  virtual void number(const FieldInfo& field, const NumberRule& /*rule*/, double& /*value*/) {
    key(field);
  }
  virtual void whole_number(const FieldInfo& field, const WholeRule& /*rule*/,
                            std::uint32_t& /*value*/) {
    key(field);
  }
  virtual void boolean(const FieldInfo& field, bool& /*value*/) { key(field); }
  virtual void text(const FieldInfo& field, std::string& /*value*/) { key(field); }
  /// A list of texts.
  virtual void texts(const FieldInfo& field, std::vector<std::string>& /*values*/) { key(field); }
  /// A path, seen from the folder of the file, or the name of a built-in model.
  virtual void path(const FieldInfo& field, std::string& /*value*/) { key(field); }
  /// A path, seen from the folder of the file, or a list of them.
  virtual void paths(const FieldInfo& field, std::vector<std::string>& /*values*/) { key(field); }
  /// One of the words; `value` is its index.
  virtual void word(const FieldInfo& field, std::span<const char* const> /*words*/,
                    std::size_t& /*value*/) {
    key(field);
  }
  /// A list of words, or how many of them.
  virtual void words_or_count(const FieldInfo& field, std::span<const char* const> /*words*/,
                              std::uint32_t /*max_size*/, std::vector<std::string>& /*chosen*/,
                              std::uint32_t& /*count*/) {
    key(field);
  }
  virtual void numbers(const FieldInfo& field, const NumberListRule& /*rule*/,
                       std::vector<double>& /*values*/) {
    key(field);
  }
  /// Whole numbers that only reports have.
  virtual void whole_numbers(const FieldInfo& field, const std::vector<std::uint32_t>& /*values*/) {
    key(field);
  }
  /// Pairs (position, value); the unit is that of the positions.
  virtual void table(const FieldInfo& field, const NumberRule& /*position*/,
                     const NumberRule& /*value*/, LookupTable& /*pairs*/) {
    key(field);
  }
  /// A vector that may be absent. Returns whether it is present.
  virtual bool vector(const FieldInfo& field, const NumberRule& /*rule*/, bool is_present,
                      Eigen::Vector3d& /*value*/) {
    key(field);
    return is_present;
  }
  /// A nested map that may be absent. Returns whether it is present.
  virtual bool object(const FieldInfo& field, bool is_present, Describe /*describe*/) {
    key(field);
    return is_present;
  }
  /// A text, or a nested map in its place; `allowed` is for errors. The text of a map is empty.
  virtual void text_or_object(const FieldInfo& field, const char* /*allowed*/,
                              std::string& /*value*/, Describe /*describe*/) {
    key(field);
  }
  virtual void list(const FieldInfo& field, const ListAccess& /*access*/, DescribeAt /*describe*/) {
    key(field);
  }
  /// A map of maps by names of the user's own.
  virtual void by_name(const FieldInfo& field, const NamesAccess& /*access*/,
                       DescribeAt /*describe*/) {
    key(field);
  }
  /// Alternatives by the word of a key, each with keys of its own in the same map.
  virtual void variant(const FieldInfo& field, std::span<const TypeInfo> types, std::size_t chosen,
                       DescribeAt describe) = 0;
  /// Where numbers come from: a map of texts by other keys of this map, or a list of such keys.
  virtual void provenance(const FieldInfo& field, bool /*is_map*/) { key(field); }

  /// A key of a file that describes several sensors.
  virtual void family(const FieldInfo& field, FamilyKey /*key*/) { key(field); }

  /// Keys of which a map has at most one.
  virtual void at_most_one(const KeyChoice& /*choice*/) {}
  /// Keys that a map may not have in a case.
  virtual void excludes(const KeyExclusion& /*exclusion*/) {}
  /// A key that needs another one beside it.
  virtual void needs(const KeyNeed& /*need*/) {}

  /// Whether the file has the key; only readers know.
  [[nodiscard]] virtual bool has(const char* /*key*/) const { return false; }
  /// Whether the value of a key of the file is a list; only readers know.
  [[nodiscard]] virtual bool is_list(const char* /*key*/) const { return false; }
  /// The file that is read; empty: none.
  [[nodiscard]] virtual std::string file() const { return ""; }
  /// The place of a key in it, or of its map where the key is missing, for later errors.
  [[nodiscard]] virtual std::string where(const char* /*key*/) const { return ""; }
  /// Throws Error at a key of the file, or at its map where the key is missing. "{}" in `found`
  /// is replaced by the value. Only readers know the place.
  [[noreturn]] void reject(const char* key, const std::string& found, const std::string& allowed,
                           const std::string& remedy = "") const;

 protected:
  virtual void key(const FieldInfo& /*field*/) {}
  /// What reject() throws; `where` is the key.
  [[nodiscard]] virtual Error error_at(const ErrorParts& parts) const;
};

/// An enumerator by its word.
template <class Value, std::size_t kCount>
void visit_choice(FieldVisitor& visitor, const FieldInfo& field,
                  const std::array<Named<Value>, kCount>& names, Value& value) {
  std::array<const char*, kCount> words{};
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    words[i] = names[i].name;
    if (names[i].value == value) chosen = i;
  }
  visitor.word(field, words, chosen);
  if (visitor.is_reading()) value = names[chosen].value;
}

/// The same for an enumerator that may be absent.
template <class Value, std::size_t kCount>
void visit_choice(FieldVisitor& visitor, const FieldInfo& field,
                  const std::array<Named<Value>, kCount>& names, std::optional<Value>& value) {
  if (visitor.is_writing() && !value) return;
  Value chosen = value.value_or(names.front().value);
  visit_choice(visitor, field, names, chosen);
  if (visitor.is_reading() && visitor.has(field.key)) value = chosen;
}

/// A struct as a nested map.
template <class Struct>
void visit_object(FieldVisitor& visitor, const FieldInfo& field, Struct& value) {
  const auto body = [&](FieldVisitor& nested) { describe(value, nested); };
  visitor.object(field, true, FieldVisitor::Describe(body));
}

template <class Struct>
void visit_object(FieldVisitor& visitor, const FieldInfo& field, std::optional<Struct>& value) {
  Struct content = value.value_or(Struct{});
  const auto body = [&](FieldVisitor& nested) { describe(content, nested); };
  const bool is_present = visitor.object(field, value.has_value(), FieldVisitor::Describe(body));
  if (visitor.is_reading() && is_present) value = std::move(content);
}

/// A list of structs; those that a reader adds are copies of `item`.
template <class Struct>
void visit_list(FieldVisitor& visitor, const FieldInfo& field, const WholeRule& size,
                const char* allowed, std::vector<Struct>& values, const Struct& item = {}) {
  const auto resize = [&](std::size_t count) { values.resize(count, item); };
  const auto body = [&](std::size_t i, FieldVisitor& nested) { describe(values[i], nested); };
  visitor.list(field,
               {size.min, size.max, allowed, values.size(), FunctionRef<void(std::size_t)>(resize)},
               FieldVisitor::DescribeAt(body));
}

/// The alternatives of a variant, which are found by the kType of each, in any order.
template <class... Types>
void visit_variant(FieldVisitor& visitor, const FieldInfo& field, std::variant<Types...>& value) {
  static constexpr std::array<TypeInfo, sizeof...(Types)> kTypes = {Types::kType...};
  using Select = void (*)(std::variant<Types...>&, FieldVisitor&);
  static constexpr std::array<Select, sizeof...(Types)> kSelect = {
      [](std::variant<Types...>& selected, FieldVisitor& nested) {
        if (!std::holds_alternative<Types>(selected)) selected = Types{};
        describe(std::get<Types>(selected), nested);
      }...};
  const auto body = [&](std::size_t i, FieldVisitor& nested) { kSelect[i](value, nested); };
  visitor.variant(field, kTypes, value.index(), FieldVisitor::DescribeAt(body));
}

/// The kType of the alternative that a variant holds.
template <class... Types>
const TypeInfo& type_info(const std::variant<Types...>& value) {
  return std::visit(
      [](const auto& alternative) -> const TypeInfo& {
        return std::decay_t<decltype(alternative)>::kType;
      },
      value);
}

}  // namespace glidar
