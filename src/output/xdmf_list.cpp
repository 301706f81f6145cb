// SPDX-License-Identifier: BSD-3-Clause
#include "output/xdmf_list.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/text_file.hpp"
#include "output/atomic_file.hpp"
#include "output/disk_space.hpp"

namespace rhexis::output {
namespace {

constexpr std::string_view opening = "<!-- ->";  // with '-' at `switch_at` it is a comment of its own
constexpr std::size_t switch_at = 4;
constexpr std::string_view closing = "-->";

std::string empty_slot(std::size_t longest_entry) {
  return std::string(opening) + std::string(longest_entry, ' ') + std::string(closing) + '\n';
}

}  // namespace

XdmfList::XdmfList(std::filesystem::path path, std::string head, std::string tail, std::size_t longest_entry)
    : path_(std::move(path)),
      head_(std::move(head)),
      tail_(std::move(tail)),
      longest_entry_(longest_entry),
      slot_bytes_(empty_slot(longest_entry).size()) {}

void XdmfList::make_room() {
  const std::size_t more = std::max<std::size_t>(slots_, 8);
  std::string text = slots_ == 0 ? head_ : whole_file(path_);
  text.resize(offset_of(slots_));
  text.reserve(text.size() + more * slot_bytes_ + tail_.size());
  for (std::size_t i = 0; i < more; ++i) text += empty_slot(longest_entry_);
  text += tail_;
  write_atomically(path_, text);
  slots_ += more;
}

void XdmfList::add(std::string_view entry) {
  if (entry.size() > longest_entry_) throw std::logic_error("a step's entry is longer than its slot");
  if (used_ == slots_) make_room();
  const FileInPlace file(path_);
  const std::size_t start = offset_of(used_), text = start + opening.size();
  // With blanks over what an earlier attempt may have left.
  file.write(text, std::string(entry) + std::string(longest_entry_ - entry.size(), ' '));
  // Else a machine that stops could keep the switch and lose the text.
  file.sync();
  file.write(start + switch_at, "-");
  file.write(text + longest_entry_, std::string(closing.size(), ' '));
  ++used_;
}

void XdmfList::remove_last() {
  const FileInPlace file(path_);
  const std::size_t start = offset_of(used_ - 1), text = start + opening.size();
  file.write(text + longest_entry_, closing);
  file.write(start + switch_at, " ");
  file.write(text, std::string(longest_entry_, ' '));
  --used_;
}

}  // namespace rhexis::output
