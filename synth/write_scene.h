// synth/write_scene.h -- writes a scene as Level II files.
//
// Threads   write_scene() uses `threads` threads of its own.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "stormcellar/base/file_system.h"
#include "synth/synth_scene.h"

namespace stormcellar::synth {

struct WriteSceneOptions {
    int threads = 1;                          // volumes that are observed and written at once
    const std::atomic<bool>* stop = nullptr;  // when set, no further volume is begun
    // Called after each volume, by only one thread at a time.
    std::function<void(const std::filesystem::path& file)> written;
};

struct WrittenScene {
    std::vector<std::filesystem::path> files;  // in order of time; all files, unless stopped
    std::uint64_t bytes = 0;
    bool stopped = false;
};

// Writes every volume into `directory`, which is made if it does not exist. Files with the same
// name are replaced, and each file appears whole or not at all. The bytes are always the same, for
// any number of threads. The first error ends the work; files that were written before the error
// stay.
[[nodiscard]] Result<WrittenScene> write_scene(const Scene& scene,
                                               const std::filesystem::path& directory,
                                               FileSystem& file_system,
                                               const WriteSceneOptions& options = {});

}  // namespace stormcellar::synth
