// The flat list of keys and values, from files, texts and --set.
#include "input/document.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/error.hpp"

namespace rhexis::input {
namespace {

const Entry& entry_of(const Document& document, const std::string& key) {
  for (const Entry& entry : document.entries)
    if (entry.key == key) return entry;
  throw std::out_of_range(key);
}

std::string value_of(const Document& document, const std::string& key) {
  return written(entry_of(document, key).value);
}

Document with_override(const std::string& argument, std::string_view text = "") {
  return parse_document(text, "a.toml", std::vector{argument});
}

TEST(Document, KeepsTheOrderOfTheFile) {
  const auto document = parse_document("[zebra]\nb = 1\na = 2\n[ant]\nc = { }.x\n", "a.toml");
  FAIL() << document.entries.size();
}

}  // namespace
}  // namespace rhexis::input
