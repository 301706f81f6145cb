// SPDX-License-Identifier: BSD-3-Clause
#include "network/files/xml_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>

#include "core/error.hpp"
#include "core/scanning.hpp"
#include "core/text_encoding.hpp"

namespace rhexis::network {
namespace {

bool is_blank(char c) {
  return blanks.find(c) != std::string_view::npos;
}

}  // namespace

void XmlReader::refuse(const std::string& problem) const {
  throw InputError(where() + ": not well-formed XML: " + problem);
}

/// Takes the text up to and with `end`, and counts its lines; returns what is before `end`.
std::string_view XmlReader::upto(std::string_view end, const char* what) {
  const auto found = text_.find(end);
  if (found == std::string_view::npos) refuse(std::string(what) + " does not end; is the file cut short?");
  const std::string_view before = text_.substr(0, found);
  line_ += static_cast<std::size_t>(std::ranges::count(before, '\n'));
  text_.remove_prefix(found + end.size());
  return before;
}

bool XmlReader::take(std::string_view start) {
  if (!text_.starts_with(start)) return false;
  text_.remove_prefix(start.size());
  return true;
}

void XmlReader::skip_blanks() {
  while (!text_.empty() && is_blank(text_.front())) {
    if (text_.front() == '\n') ++line_;
    text_.remove_prefix(1);
  }
}

/// Comments, declarations and instructions.
bool XmlReader::skip_what_is_no_element() {
  if (take("<!--")) {
    upto("-->", "a comment");
  } else if (take("<?")) {
    upto("?>", "an instruction");
  } else if (take("<!DOCTYPE")) {
    if (upto(">", "the document type").find('[') != std::string_view::npos)
      refuse("documents that declare their own entities are not read");
  } else {
    return false;
  }
  return true;
}

XmlReader::Event XmlReader::next() {
  if (is_empty_element_) {
    is_empty_element_ = false;
    return end_element(open_.back());
  }
  while (!text_.empty()) {
    if (skip_what_is_no_element()) continue;
    if (take("</")) return end_element(std::string(without_blanks(upto(">", "a tag"))));
    if (take("<![CDATA[")) {
      content_ = upto("]]>", "a CDATA section");
      if (!content_.empty()) return Event::text;
    } else if (take("<")) {
      return begin_element();
    } else {
      const std::string_view raw = text_.substr(0, text_.find('<'));
      const std::string_view content = without_blanks(raw);
      if (!content.empty() && open_.empty()) refuse("text outside of all elements");
      content_ = decoded(content);
      line_ += static_cast<std::size_t>(std::ranges::count(raw, '\n'));
      text_.remove_prefix(raw.size());
      if (!content.empty()) return Event::text;
    }
  }
  if (!open_.empty()) refuse("<" + open_.back() + "> does not end; is the file cut short?");
  if (!has_root_) refuse("there is no element");
  return Event::finished;
}

XmlReader::Event XmlReader::begin_element() {
  name_ = take_name();
  if (open_.empty() && has_root_) refuse("a second root element, <" + name_ + ">");
  has_root_ = true;
  attributes_.clear();
  while (true) {
    skip_blanks();
    if (take("/>")) {
      is_empty_element_ = true;
      break;
    }
    if (take(">")) break;
    const std::string attribute = take_name();
    skip_blanks();
    if (!take("=")) refuse("attribute " + attribute + " has no value");
    skip_blanks();
    const char* quote = take("\"") ? "\"" : take("'") ? "'" : nullptr;
    if (quote == nullptr) refuse("the value of attribute " + attribute + " is not quoted");
    attributes_.emplace_back(attribute, decoded(upto(quote, "a value")));
  }
  open_.push_back(name_);
  return Event::begin;
}

XmlReader::Event XmlReader::end_element(const std::string& name) {
  const std::string local = name.substr(name.find(':') + 1);
  if (open_.empty() || open_.back() != local)
    refuse("</" + local + "> ends " + (open_.empty() ? "nothing" : "<" + open_.back() + ">"));
  name_ = open_.back();
  open_.pop_back();
  return Event::end;
}

/// Takes a name, up to a blank or a sign of the syntax, and leaves out its prefix.
std::string XmlReader::take_name() {
  const auto end = text_.find_first_of(" \t\r\n=/><\"'");
  if (end == 0 || end == std::string_view::npos) refuse("a name is expected");
  const std::string_view name = text_.substr(0, end);
  text_.remove_prefix(end);
  return std::string(name.substr(name.find(':') + 1));
}

std::string XmlReader::attribute(std::string_view name) const {
  const auto found =
      std::ranges::find(attributes_, name, [](const auto& pair) { return std::string_view(pair.first); });
  return found == attributes_.end() ? std::string() : found->second;
}

/// A text with its entities replaced.
std::string XmlReader::decoded(std::string_view raw) const {
  constexpr std::pair<std::string_view, char> named[] = {
      {"lt", '<'}, {"gt", '>'}, {"amp", '&'}, {"quot", '"'}, {"apos", '\''}};
  std::string text;
  while (true) {
    const auto ampersand = raw.find('&');
    text += raw.substr(0, ampersand);
    if (ampersand == std::string_view::npos) return text;
    raw.remove_prefix(ampersand + 1);
    const auto end = raw.find(';');
    if (end == std::string_view::npos) refuse("an entity does not end in ';'");
    std::string_view entity = raw.substr(0, end);
    raw.remove_prefix(end + 1);
    if (const auto found = std::ranges::find(named, entity, [](const auto& n) { return n.first; });
        found != std::end(named)) {
      text += found->second;
      continue;
    }
    if (!entity.starts_with('#')) refuse("entity '" + std::string(entity.substr(0, 60)) + "' is not known");
    std::uint32_t character = 0;
    const int base = entity.starts_with("#x") ? 16 : 10;
    entity.remove_prefix(base == 16 ? 2 : 1);
    const auto [last, error] = std::from_chars(entity.data(), entity.data() + entity.size(), character, base);
    if (error != std::errc() || last != entity.data() + entity.size() || character == 0 ||
        character > 0x10FFFF)
      refuse("an entity is no character");
    append_utf8(text, character);
  }
}

}  // namespace rhexis::network
