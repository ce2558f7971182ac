#pragma once
// Files in and out of a run. A file is there whole or not at all.

#include "schemas/read_scene.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace toile {

/// Throws InputError (file_not_found, file_too_large) at pointer "".
std::string read_input_file(const std::filesystem::path& path, std::size_t limit);

/// A scene's file with the files that it refers to, relative to it. Throws InputError.
Job read_job(const std::filesystem::path& scene);

/// Writes a temporary file beside `path` and renames it. Throws std::system_error.
void write_atomically(const std::filesystem::path& path, std::string_view bytes);

/// Removes what an earlier run left in the folder, so that nothing stale is taken for this run's.
void remove_old_results(const std::filesystem::path& out);

}  // namespace toile
