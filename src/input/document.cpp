// SPDX-License-Identifier: BSD-3-Clause
#include "input/document.hpp"

#include <fmt/format.h>

// Errors come back as values: they are reworded here. toml++ 3.3 asserts, or with NDEBUG lets the compiler
// assume, what a malformed header such as "[}a]" breaks; with neither, it goes on to report the error.
#undef NDEBUG
#define TOML_ASSERT(expression) static_assert(true)
#define TOML_EXCEPTIONS 0
#include <toml++/toml.h>

#include <algorithm>
#include <optional>
#include <tuple>

#include "core/error.hpp"
#include "core/printable.hpp"
#include "core/text_file.hpp"
#include "input/wording.hpp"

namespace rhexis::input {
namespace {

constexpr std::string_view accepted_types =
    "a number, a text in quotes, true or false, or a list of these (no dates, times or tables)";

/// The value of a node, or none for a type that no key takes.
std::optional<Value> to_value(const toml::node& node) {
  if (const auto* text = node.as_string()) return Value{text->get()};
  if (const auto* whole = node.as_integer()) return Value{whole->get()};
  if (const auto* real = node.as_floating_point()) return Value{real->get()};
  if (const auto* flag = node.as_boolean()) return Value{flag->get()};
  if (const auto* array = node.as_array()) {
    List list;
    for (const toml::node& element : *array) {
      auto value = to_value(element);
      if (!value) return std::nullopt;
      list.push_back(std::move(*value));
    }
    return Value{std::move(list)};
  }
  return std::nullopt;
}

/// toml++'s description of an error, without what the position says better.
std::string reason(const toml::parse_error& error) {
  const std::string text(error.description());
  if (text.find("utf-8") != std::string::npos) return "the file is not UTF-8 text";
  const auto colon = text.find(": ");
  const std::string context = text.substr(0, colon == std::string::npos ? 0 : colon);
  const std::string brief = context.empty() ? text : text.substr(colon + 2);
  if (brief.starts_with("cannot redefine"))
    return fmt::format("defined twice: {}; each section and each key may appear once", brief);
  const bool in_a_value =
      context.ends_with("key-value pair") || context.ends_with("value") || context.ends_with("boolean");
  return fmt::format("not valid TOML: {}{}", brief,
                     in_a_value ? "; a text, or a number with a unit, goes in quotes, as in \"1.5 mm\"" : "");
}

/// Where a string or a comment that begins `text` ends, in bytes; 0 where none begins there.
std::size_t quoted_length(std::string_view text) {
  if (text.front() == '#') return std::min(text.find('\n'), text.size());
  if (text.front() != '"' && text.front() != '\'') return 0;
  const bool has_escapes = text.front() == '"';
  const std::string_view triple = has_escapes ? R"(""")" : "'''";
  const bool has_lines = text.starts_with(triple);
  const std::string_view end = has_lines ? triple : triple.substr(0, 1);
  for (std::size_t i = end.size(); i < text.size(); ++i) {
    if (text.substr(i).starts_with(end)) return i + end.size();
    if (text[i] == '\n' && !has_lines) return i;
    if (text[i] == '\\' && has_escapes) ++i;
  }
  return text.size();
}

/// The first character that is not ASCII and stands outside of strings and comments, where TOML 1.0 has none.
/// toml++ 3.3 cannot be given these: its test for white space ends in an unreachable statement for most
/// letters of Latin, Greek and Cyrillic script. None where there is none, or where the text is not UTF-8.
struct Outsider {
  int line, column;
  std::string character;
};
std::optional<Outsider> first_outsider(std::string_view text) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  int line = 1, column = 1;
  for (std::size_t i = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0; i < text.size();) {
    const std::string_view rest = text.substr(i);
    if (const std::size_t quoted = quoted_length(rest); quoted > 0) {
      for (const char c : rest.substr(0, quoted)) {
        if (c == '\n')
          ++line, column = 1;
        else if ((static_cast<unsigned char>(c) & 0xC0U) != 0x80U)
          ++column;
      }
      i += quoted;
      continue;
    }
    const std::size_t length = utf8_length(rest);
    if (length == 0) return {};
    if (length > 1) return Outsider{line, column, std::string(rest.substr(0, length))};
    ++column;
    if (text[i++] == '\n') ++line, column = 1;
  }
  return {};
}

/// Whether a text in it has control characters: no key means any, paths end at them, terminals obey them.
bool has_control_character(const Value& value) {
  if (const auto* text = std::get_if<std::string>(&value.content))
    return std::ranges::any_of(*text, [](unsigned char c) { return c < 0x20 || c == 0x7F; });
  const auto* list = std::get_if<List>(&value.content);
  return list && std::ranges::any_of(*list, has_control_character);
}

constexpr const char* no_control_characters =
    "a text with a control character, such as a line break, which no key takes";

/// Flattens the tables of a file into sections and entries.
class Flattener {
 public:
  explicit Flattener(Document& document) : document_(document) {}

  void add(const toml::table& root) {
    for (const auto& [key, node] : root) {
      const std::string name(key.str());
      check_name(name, key);
      if (const auto* section = node.as_table()) {
        document_.sections.push_back({name, static_cast<int>(key.source().begin.line)});
        add_section(name, *section);
      } else if (node.is_array_of_tables()) {
        int number = 0;
        for (const toml::node& element : *node.as_array()) {
          document_.sections.push_back({name, static_cast<int>(element.source().begin.line), ++number});
          add_section(fmt::format("{}[{}]", name, number), *element.as_table());
        }
      } else {
        add_entry(name, key, node);
      }
    }
    std::ranges::sort(document_.sections, {}, &Section::line);
    std::ranges::sort(document_.entries, {}, [](const Entry& e) { return std::tuple(e.line, e.column); });
  }

 private:
  [[noreturn]] void fail(const toml::key& key, const std::string& problem) const {
    throw InputError(fmt::format("{}:{}: {}", document_.file, key.source().begin.line, problem));
  }

  /// Quoted names may hold anything; a dot would make "section.name" ambiguous, a line break spoil the
  /// messages.
  void check_name(const std::string& name, const toml::key& key) const {
    constexpr std::string_view usual = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    constexpr std::size_t longest = 80;
    if (name.empty() || name.size() > longest || name.find_first_not_of(usual) != std::string::npos)
      fail(key, fmt::format("the name {} is not one of letters, digits, _ and -, at most {} of them; write "
                            "[section] and below it name = value",
                            in_quotes(shortened(name)), longest));
  }

  void add_section(const std::string& name, const toml::table& section) {
    for (const auto& [key, node] : section) {
      check_name(std::string(key.str()), key);
      add_entry(fmt::format("{}.{}", name, key.str()), key, node);
    }
  }

  void add_entry(std::string name, const toml::key& key, const toml::node& node) {
    if (node.is_table() || node.is_array_of_tables())
      fail(key, fmt::format("unexpected table '{}': keys are section.name and no deeper", name));
    auto value = to_value(node);
    if (!value) fail(key, fmt::format("{} has a type that no key takes; write {}", name, accepted_types));
    if (has_control_character(*value))
      fail(key, fmt::format("{} = {}: {}", name, shortened(written(*value)), no_control_characters));
    const auto begin = key.source().begin;
    document_.entries.push_back({std::move(name),
                                 std::move(*value),
                                 static_cast<int>(begin.line),
                                 static_cast<int>(begin.column),
                                 {}});
  }

  Document& document_;
};

/// An argument of --set as a message has it: on one line.
std::string shown(const std::string& argument) {
  std::string text = shortened(argument);
  std::ranges::replace(text, '\n', ' ');
  return text;
}

void apply_override(Document& document, const std::string& argument) {
  const std::string place = "--set " + shown(argument);
  const auto equals = argument.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError(place + ": write --set section.name=value, for example --set \"vessel.length=20 mm\"");
  Entry entry{.key = argument.substr(0, equals), .value = {}, .argument = argument};
  entry.key.erase(entry.key.find_last_not_of(' ') + 1);
  try {
    entry.value = parse_value(std::string_view(argument).substr(equals + 1));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", place, error.what()), entry.key);
  }
  const auto same = std::ranges::find(document.entries, entry.key, &Entry::key);
  if (same == document.entries.end())
    document.entries.push_back(std::move(entry));
  else
    *same = std::move(entry);
}

Value checked(Value value) {
  if (has_control_character(value)) throw InputError(no_control_characters);
  return value;
}

struct Writer {
  std::string operator()(bool flag) const { return flag ? "true" : "false"; }
  std::string operator()(std::int64_t whole) const { return fmt::format("{}", whole); }
  std::string operator()(double real) const { return fmt::format("{}", real); }
  std::string operator()(const std::string& text) const { return in_quotes(text); }
  std::string operator()(const List& list) const {
    std::string elements;
    for (const Value& element : list) {
      if (!elements.empty()) elements += ", ";
      elements += written(element);
    }
    return fmt::format("[{}]", elements);
  }
};

}  // namespace

std::string written(const Value& value) {
  return std::visit(Writer{}, value.content);
}

std::string Document::place(const Entry& entry) const {
  if (!entry.from_file()) return "--set " + shown(entry.argument);
  return fmt::format("{}:{}: {} = {}", file, entry.line, entry.key, shortened(written(entry.value)));
}

std::string read_text(const std::filesystem::path& file) {
  const auto fail = [&file](std::string_view problem) {
    throw InputError(fmt::format("{}: {}", file.string(), problem));
  };
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) fail("this is a folder; give an input file (TOML)");
  // Inputs are a few kilobytes; a curve of a million points has some 40 MB.
  return whole_file(file, 64'000'000,
                    ", too large for an input file (TOML); a long load.table goes into load.table_file");
}

Document parse_document(std::string_view text, std::string file, std::span<const std::string> overrides) {
  Document document{.file = std::move(file), .sections = {}, .entries = {}};
  if (const auto outsider = first_outsider(text))
    throw InputError(
        fmt::format("{}:{}:{}: not valid TOML: '{}' outside of quotes; names are of the letters a to "
                    "z, digits, _ and -, and texts stand in quotes",
                    document.file, outsider->line, outsider->column, outsider->character));
  const toml::parse_result result = toml::parse(text);
  if (!result) {
    const auto at = result.error().source().begin;
    throw InputError(fmt::format("{}:{}:{}: {}", document.file, at.line, at.column, reason(result.error())));
  }
  Flattener(document).add(result.table());
  for (const std::string& argument : overrides) apply_override(document, argument);
  return document;
}

Value parse_value(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) throw InputError("a value is missing");
  text = text.substr(first, text.find_last_not_of(" \t") - first + 1);
  if (!first_outsider(text)) {
    const toml::parse_result result = toml::parse(fmt::format("value = {}", text));
    const bool one_value = result && result.table().size() == 1;
    if (one_value)
      if (auto value = to_value(*result.table().get("value"))) return checked(std::move(*value));
  }
  if (std::string_view("[{\"'").find(text.front()) != std::string_view::npos)
    throw InputError(
        fmt::format("not a valid value; write {}. The shell takes quotes away: put single quotes "
                    "around it all, as in --set 'section.name=[\"a\", \"b\"]'",
                    accepted_types));
  constexpr std::string_view replacement_character =
      "\xEF\xBF\xBD";  // what in_quotes() puts for invalid bytes
  if (in_quotes(text).find(replacement_character) != std::string::npos)
    throw InputError("the value is not UTF-8 text");
  return checked(Value{std::string(text)});
}

}  // namespace rhexis::input
