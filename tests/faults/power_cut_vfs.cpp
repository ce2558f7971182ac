#include "tests/faults/power_cut_vfs.h"

#include <sqlite3.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace toile {
namespace {

namespace fs = std::filesystem;

/// One change and what it destroyed: bytes before it at `offset`, and the file's size before it.
struct Change {
  std::string path;
  sqlite3_int64 offset, old_size;
  std::string old_bytes;
};

// SQLite's callbacks reach nothing but globals.
std::mutex mutex;
std::vector<Change> changes;

struct File {
  sqlite3_file base;
  std::string* path;
  sqlite3_file* real() { return reinterpret_cast<sqlite3_file*>(this + 1); }
};

File* file_of(sqlite3_file* file) { return reinterpret_cast<File*>(file); }
sqlite3_vfs* real_vfs(sqlite3_vfs* vfs) { return static_cast<sqlite3_vfs*>(vfs->pAppData); }

void remember(File* file, sqlite3_int64 offset, sqlite3_int64 length) {
  sqlite3_int64 size = 0;
  file->real()->pMethods->xFileSize(file->real(), &size);
  std::string old(static_cast<std::size_t>(std::clamp<sqlite3_int64>(size - offset, 0, length)), '\0');
  if (!old.empty()) {
    file->real()->pMethods->xRead(file->real(), old.data(), static_cast<int>(old.size()), offset);
  }
  const std::lock_guard lock(mutex);
  changes.push_back({*file->path, offset, size, std::move(old)});
}

void forget(const std::string& path) {
  const std::lock_guard lock(mutex);
  std::erase_if(changes, [&](const Change& change) { return change.path == path; });
}

int close_file(sqlite3_file* file) {
  const int code = file_of(file)->real()->pMethods->xClose(file_of(file)->real());
  delete file_of(file)->path;
  return code;
}
int read_file(sqlite3_file* file, void* buffer, int amount, sqlite3_int64 offset) {
  return file_of(file)->real()->pMethods->xRead(file_of(file)->real(), buffer, amount, offset);
}
int write_file(sqlite3_file* file, const void* buffer, int amount, sqlite3_int64 offset) {
  remember(file_of(file), offset, amount);
  return file_of(file)->real()->pMethods->xWrite(file_of(file)->real(), buffer, amount, offset);
}
int truncate_file(sqlite3_file* file, sqlite3_int64 size) {
  sqlite3_int64 old = 0;
  file_of(file)->real()->pMethods->xFileSize(file_of(file)->real(), &old);
  remember(file_of(file), size, std::max<sqlite3_int64>(0, old - size));
  return file_of(file)->real()->pMethods->xTruncate(file_of(file)->real(), size);
}
int sync_file(sqlite3_file* file, int flags) {
  const int code = file_of(file)->real()->pMethods->xSync(file_of(file)->real(), flags);
  if (code == SQLITE_OK) forget(*file_of(file)->path);
  return code;
}
int file_size(sqlite3_file* file, sqlite3_int64* size) {
  return file_of(file)->real()->pMethods->xFileSize(file_of(file)->real(), size);
}
int lock_file(sqlite3_file* file, int level) {
  return file_of(file)->real()->pMethods->xLock(file_of(file)->real(), level);
}
int unlock_file(sqlite3_file* file, int level) {
  return file_of(file)->real()->pMethods->xUnlock(file_of(file)->real(), level);
}
int check_lock(sqlite3_file* file, int* result) {
  return file_of(file)->real()->pMethods->xCheckReservedLock(file_of(file)->real(), result);
}
int control(sqlite3_file* file, int operation, void* argument) {
  return file_of(file)->real()->pMethods->xFileControl(file_of(file)->real(), operation, argument);
}
int sector_size(sqlite3_file* file) { return file_of(file)->real()->pMethods->xSectorSize(file_of(file)->real()); }
int characteristics(sqlite3_file* file) {
  return file_of(file)->real()->pMethods->xDeviceCharacteristics(file_of(file)->real());
}
int shm_map(sqlite3_file* file, int page, int size, int extend, void volatile** memory) {
  return file_of(file)->real()->pMethods->xShmMap(file_of(file)->real(), page, size, extend, memory);
}
int shm_lock(sqlite3_file* file, int offset, int count, int flags) {
  return file_of(file)->real()->pMethods->xShmLock(file_of(file)->real(), offset, count, flags);
}
void shm_barrier(sqlite3_file* file) { file_of(file)->real()->pMethods->xShmBarrier(file_of(file)->real()); }
int shm_unmap(sqlite3_file* file, int remove) {
  return file_of(file)->real()->pMethods->xShmUnmap(file_of(file)->real(), remove);
}

// Version 2: without memory-mapped pages, so that every write passes by.
constexpr sqlite3_io_methods kMethods{2,           close_file,  read_file,       write_file,  truncate_file,
                                      sync_file,   file_size,   lock_file,       unlock_file, check_lock,
                                      control,     sector_size, characteristics, shm_map,     shm_lock,
                                      shm_barrier, shm_unmap,   nullptr,         nullptr};

int open_file(sqlite3_vfs* vfs, const char* name, sqlite3_file* file, int flags, int* flags_out) {
  File* const opened = file_of(file);
  opened->base.pMethods = nullptr;
  const int code = real_vfs(vfs)->xOpen(real_vfs(vfs), name, opened->real(), flags, flags_out);
  if (opened->real()->pMethods == nullptr) return code;
  opened->path = new std::string(name == nullptr ? "" : name);
  opened->base.pMethods = &kMethods;
  return code;
}

int delete_file(sqlite3_vfs* vfs, const char* name, int sync) {
  forget(name);
  return real_vfs(vfs)->xDelete(real_vfs(vfs), name, sync);
}

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void undo(const Change& change, std::string& content) {
  if (content.size() < static_cast<std::size_t>(change.offset) + change.old_bytes.size()) {
    content.resize(static_cast<std::size_t>(change.offset) + change.old_bytes.size());
  }
  content.replace(static_cast<std::size_t>(change.offset), change.old_bytes.size(), change.old_bytes);
  content.resize(static_cast<std::size_t>(change.old_size));
}

}  // namespace

void install_power_cut_vfs() {
  static sqlite3_vfs layer = [] {
    sqlite3_vfs* const real = sqlite3_vfs_find(nullptr);
    sqlite3_vfs made = *real;
    made.pNext = nullptr;
    made.szOsFile = static_cast<int>(sizeof(File)) + real->szOsFile;
    made.zName = kPowerCutVfs;
    made.pAppData = real;
    made.xOpen = open_file;
    made.xDelete = delete_file;
    return made;
  }();
  sqlite3_vfs_register(&layer, 0);
  const std::lock_guard lock(mutex);
  changes.clear();
}

void copy_after_power_cut(const fs::path& folder, const fs::path& copy, std::size_t survivors) {
  fs::remove_all(copy);
  fs::create_directories(copy);
  const std::lock_guard lock(mutex);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name == "lock" || name.ends_with("-shm")) continue;
    std::string content = content_of(entry.path());
    for (std::size_t i = changes.size(); i > std::min(survivors, changes.size()); --i) {
      if (changes[i - 1].path == entry.path().string()) undo(changes[i - 1], content);
    }
    std::ofstream(copy / name, std::ios::binary) << content;
  }
}

std::size_t unsynced_changes() {
  const std::lock_guard lock(mutex);
  return changes.size();
}

}  // namespace toile
