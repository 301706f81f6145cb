// SPDX-License-Identifier: BSD-3-Clause
/// Small tools for messages to people.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace rhexis::input {

/// `text` as TOML and JSON write it: in double quotes, on one line.
std::string in_quotes(std::string_view text);

/// The texts quoted, with commas between them.
std::string quoted_list(std::span<const std::string> texts);

/// `text` cut to what a message can hold, with "..." at the cut.
std::string shortened(std::string text);

/// The candidate that `word` was probably meant to be: a few letters wrong, or a part of it; none where all
/// are far.
std::optional<std::string> closest(std::string_view word, std::span<const std::string> candidates);

/// "; did you mean X?", or nothing.
std::string did_you_mean(const std::optional<std::string>& suggestion);

/// Words of `text` in lines of at most `width` columns, every line after the first indented by `indent`.
std::string wrapped(std::string_view text, std::size_t width, std::size_t indent);

}  // namespace rhexis::input
