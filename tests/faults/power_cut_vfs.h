#pragma once
// A SQLite file-system layer that remembers what was written but not yet synced, so that a test can ask: what would be
// on the disk if the power went now? It writes through to the real files and keeps, per change since the file's last
// sync, what stood there before.
//
// Simplified: a directory entry counts as durable at once, and of a file's unsynced writes always the first few
// survive, never an arbitrary subset of them.

#include <filesystem>
#include <string>

namespace toile {

/// Registers the layer under the name kPowerCutVfs, once; forgets all that was remembered.
void install_power_cut_vfs();
inline constexpr const char* kPowerCutVfs = "power-cut";

/// Copies the folder as it would be after a power cut now; of the unsynced changes the first `survivors` persist. The
/// index in shared memory (-shm) is lost.
void copy_after_power_cut(const std::filesystem::path& folder, const std::filesystem::path& copy,
                          std::size_t survivors);

/// Changes that no sync has covered yet.
std::size_t unsynced_changes();

}  // namespace toile
