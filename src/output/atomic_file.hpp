/// Small text files that are never seen half written.
#pragma once

#include <filesystem>
#include <string_view>

namespace rhexis::output {

/// Replaces the file `path` by `text` in one step (a temporary file beside it, then a rename): a reader, or
/// what a crash leaves behind, has the old text or the new, never a part. Throws RunError that names the file
/// and the reason; the old file then stays. Local to the calling rank.
void write_atomically(const std::filesystem::path& path, std::string_view text);

/// After a stream failed: throws RunError that names the file and what `errno` says.
[[noreturn]] void cannot_write(const std::filesystem::path& path);

}  // namespace rhexis::output
