// SPDX-License-Identifier: BSD-3-Clause
/// A reader of XML documents, one event after the other, as far as files of data have them: elements,
/// attributes, texts, the five named entities and those by number, comments, CDATA. Documents with entities
/// of their own are refused. Names lose their namespace's prefix.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace rhexis::network {

class XmlReader {
 public:
  enum class Event { begin, end, text, finished };

  /// `text` must live as long as the reader.
  XmlReader(std::string file, std::string_view text) : file_(std::move(file)), text_(text) {}

  /// Goes to the next event. Throws InputError with file and line for what is no well-formed XML.
  Event next();

  /// The element that began or ended.
  const std::string& name() const { return name_; }
  /// A text without blanks around it; never empty.
  const std::string& text() const { return content_; }
  /// An attribute of the element that began; empty where it has none of that name.
  std::string attribute(std::string_view name) const;
  /// "n.graphml:12", of what comes next.
  std::string where() const { return file_ + ":" + std::to_string(line_); }
  std::size_t line() const { return line_; }

 private:
  [[noreturn]] void refuse(const std::string& problem) const;
  std::string_view upto(std::string_view end, const char* what);
  bool take(std::string_view start);
  bool skip_what_is_no_element();
  Event begin_element();
  Event end_element(const std::string& name);
  std::string take_name();
  void skip_blanks();
  std::string decoded(std::string_view raw) const;

  std::string file_;
  std::string_view text_;
  std::size_t line_ = 1;
  std::string name_, content_;
  std::vector<std::pair<std::string, std::string>> attributes_;
  std::vector<std::string> open_;  ///< elements that have not ended, outermost first
  bool is_empty_element_ = false, has_root_ = false;
};

}  // namespace rhexis::network
