// SPDX-License-Identifier: BSD-3-Clause
// Every write of the list is taken apart: after each of its bytes, in either order, the file must be
// well-formed XML that shows the list before the change or after it. A kill, or a reader, comes in between
// bytes at worst.
#include "output/xdmf_list.hpp"

#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <functional>
#include <set>

#include "core/error.hpp"
#include "small_disk.hpp"
#include "temporary_directory.hpp"

namespace {

/// Called after every byte that pwrite puts into a file; pwrite fails from the moment when it returns false.
std::function<bool()> after_each_byte;
bool last_byte_first = false;

}  // namespace

/// In place of the C library's.
extern "C" ssize_t pwrite(int file, const void* bytes, size_t count, off_t offset) {
  const char* first = static_cast<const char*>(bytes);
  for (size_t i = 0; i < count; ++i) {
    const size_t at = last_byte_first ? count - 1 - i : i;
    if (syscall(SYS_pwrite64, file, first + at, size_t{1}, offset + static_cast<off_t>(at)) != 1) return -1;
    if (after_each_byte && !after_each_byte()) {
      errno = EIO;
      return -1;
    }
  }
  return static_cast<ssize_t>(count);
}

namespace rhexis {
namespace {

using output::XdmfList;
using test::TemporaryDirectory;

/// What a reader sees: the text without comments, blanks, and the remains of a comment that was opened.
/// "malformed" where a comment holds two hyphens or does not end.
std::string visible(const std::string& text) {
  std::string seen;
  std::size_t at = 0;
  while (at < text.size()) {
    if (text.compare(at, 4, "<!--") == 0) {
      const std::size_t end = text.find("--", at + 4);
      if (end == std::string::npos || text.compare(end, 3, "-->") != 0) return "malformed";
      at = end + 3;
    } else {
      seen += text[at++];
    }
  }
  // Between elements, text means nothing: all of it goes.
  std::string tags;
  bool inside = false;
  for (const char c : seen) {
    if (c == '<') inside = true;
    if (inside) tags += c;
    if (c == '>') inside = false;
  }
  return tags;
}

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t times = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++times;
  return times;
}

class XdmfListTest : public testing::Test {
 protected:
  ~XdmfListTest() override { after_each_byte = nullptr; }

  std::string seen() const { return visible(test::text_of(path)); }

  /// Makes the change and checks what can be seen on the way to `after`.
  void change(const std::string& after, const std::function<void()>& action) {
    const std::string before = seen();
    std::set<std::string> states;
    after_each_byte = [&] {
      states.insert(seen());
      return true;
    };
    action();
    after_each_byte = nullptr;
    EXPECT_EQ(seen(), after);
    states.erase(before);
    states.erase(after);
    EXPECT_TRUE(states.empty()) << *states.begin();
  }

  TemporaryDirectory directory;
  std::filesystem::path path = directory / "list.xdmf";
  XdmfList list{path, "<Grid>\n", "</Grid>\n", 30};
};

TEST_F(XdmfListTest, HoldsEveryEntryAtEveryInstant) {
  std::string all = "<Grid>";
  list.add("<A Value=\"0\"/>");
  all += "<A Value=\"0\"/>";
  for (int i = 1; i < 40; ++i) {
    last_byte_first = i % 2 == 1;
    const std::string entry = "<A Value=\"-1e-" + std::to_string(i) + "\"/>";
    all += entry;
    change(all + "</Grid>", [&] { list.add(entry); });
  }
  const std::string text = test::text_of(path);
  EXPECT_EQ(count(text, "-->"), count(text, "<!--")) << "a comment's end is left as text";
}

TEST_F(XdmfListTest, AnEntryIsTakenOutAtOnceAndWhole) {
  for (const bool backwards : {false, true}) {
    last_byte_first = backwards;
    const XdmfList fresh = list;
    list.add("<First/>");
    list.add("<Second/>");
    change("<Grid><First/></Grid>", [&] { list.remove_last(); });
    EXPECT_EQ(test::text_of(path).find("Second"), std::string::npos);
    change("<Grid><First/><Third/></Grid>", [&] { list.add("<Third/>"); });
    list = fresh;
  }
}

TEST_F(XdmfListTest, AnEntryThatCannotBeWrittenIsNotListedAndTheNextTakesItsPlace) {
  list.add("<First/>");
  for (int bytes = 1; bytes < 30; ++bytes) {
    after_each_byte = [left = bytes]() mutable { return --left > 0; };
    const std::string message = test::message_of<RunError>([&] { list.add("<Second/><Second/>"); });
    after_each_byte = nullptr;
    EXPECT_EQ(message, path.string() + ": cannot write the file: Input/output error");
    EXPECT_EQ(seen(), "<Grid><First/></Grid>");
  }
  list.add("<Last/>");
  EXPECT_EQ(seen(), "<Grid><First/><Last/></Grid>");
}

TEST_F(XdmfListTest, AFullDiskLeavesTheListAsItWas) {
  const test::SmallDisk disk(directory.path(), 16384);
  if (!disk.mounted()) GTEST_SKIP() << "mounting a small file system takes the superuser";
  std::string all = "<Grid>", message;
  for (int i = 0; i < 1000 && message.empty(); ++i) {
    const std::string entry = "<A Value=\"" + std::to_string(i) + "\"/>";
    message = test::message_of<RunError>([&] { list.add(entry); });
    if (message.empty()) all += entry;
  }
  EXPECT_NE(message.find("No space left on device"), std::string::npos) << message;
  EXPECT_EQ(seen(), all + "</Grid>");
}

TEST_F(XdmfListTest, TheFileIsNotMuchLongerThanItsList) {
  for (int i = 0; i < 100; ++i) list.add("<A/>");
  EXPECT_LT(std::filesystem::file_size(path), 2u * 110u * 41u);
}

}  // namespace
}  // namespace rhexis
