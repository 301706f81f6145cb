// SPDX-License-Identifier: BSD-3-Clause
/// A list of complete steps, as an XDMF file, to which adding costs the same however long it is.
///
/// The file is well-formed XML at every instant, so that a reader, or what a kill leaves behind, has the list
/// with the step or without it. Each step has a slot of fixed length, laid out ahead, which is a comment:
///
///     <!-- ->        text of the step, or blanks        -->
///
/// An entry is written into the comment, where readers do not see it, and brought to the disk. Then one
/// byte, the only write that no reader can catch half done, turns the blank before `->` into `-`: the
/// comment ends there and the entry shows. The `-->` after it, which is plain text by then, is blanked.
/// Removing an entry is the same, backwards. When the slots are used up the file is replaced by a copy with
/// twice as many, so that the copies cost each step a constant on average, and the file is never longer than
/// about twice what it lists.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace rhexis::output {

class XdmfList {
 public:
  /// A list between `head` and `tail`; no entry is longer than `longest_entry` characters. The file is made,
  /// in place of an earlier one, with the first entry.
  XdmfList(std::filesystem::path path, std::string head, std::string tail, std::size_t longest_entry);

  /// Adds an entry, XML without comments, at the end. Throws RunError if the disk is
  /// full or the file cannot be written; the list is then as before.
  void add(std::string_view entry);

  /// Takes the last entry from the list. Throws RunError if the file cannot be written.
  void remove_last();

 private:
  std::size_t offset_of(std::size_t slot) const { return head_.size() + slot * slot_bytes_; }
  void make_room();

  std::filesystem::path path_;
  std::string head_, tail_;
  std::size_t longest_entry_, slot_bytes_;
  std::size_t used_ = 0, slots_ = 0;
};

}  // namespace rhexis::output
