#include "synth/write_scene.h"

#include <algorithm>

#include "base/parallel.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/level2/encode.h"
#include "synth/observe.h"

namespace stormcellar::synth {
namespace {

// Observes and writes the volumes of a scene. All threads share one object.
class Work {
  public:
    Work(const Scene& scene, const std::filesystem::path& directory, FileSystem& file_system,
         const WriteSceneOptions& options)
        : scene_(scene), directory_(directory), file_system_(file_system), options_(options) {}

    // Does nothing if a volume has failed or the caller has asked to stop.
    void run(int number) {
        if (stopped() || failed_) return;
        const auto path = directory_ / volume_file_name(scene_, number);
        note(number, path, write(number, path));
    }

    Result<WrittenScene> finish() {
        const MutexLock lock(mutex_);
        if (error_) return tl::unexpected(*error_);
        std::sort(done_.begin(), done_.end());
        for (const auto& [number, path] : done_) {
            written_.files.push_back(path);
        }
        written_.stopped = written_.files.size() < static_cast<std::size_t>(scene_.schedule.count);
        return std::move(written_);
    }

  private:
    [[nodiscard]] bool stopped() const { return options_.stop != nullptr && *options_.stop; }

    Result<std::uint64_t> write(int number, const std::filesystem::path& path) {
        const auto encoded = level2::encode(observe(scene_, number));
        if (!encoded) return pass_on(encoded);
        const std::vector<std::byte> bytes = encoded->joined();
        const Status status = write_file_atomically(file_system_, path, bytes);
        if (!status) return pass_on(status);
        return bytes.size();
    }

    void note(int number, const std::filesystem::path& path, const Result<std::uint64_t>& bytes) {
        const MutexLock lock(mutex_);
        if (!bytes) {
            if (!error_) error_ = bytes.error();
            failed_ = true;
            return;
        }
        written_.bytes += *bytes;
        done_.emplace_back(number, path);
        if (options_.written) options_.written(path);
    }

    const Scene& scene_;
    const std::filesystem::path& directory_;
    FileSystem& file_system_;
    const WriteSceneOptions& options_;
    std::atomic<bool> failed_{false};
    Mutex mutex_;
    std::vector<std::pair<int, std::filesystem::path>> done_ STORMCELLAR_GUARDED_BY(mutex_);
    WrittenScene written_ STORMCELLAR_GUARDED_BY(mutex_);
    std::optional<Error> error_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace

Result<WrittenScene> write_scene(const Scene& scene, const std::filesystem::path& directory,
                                 FileSystem& file_system, const WriteSceneOptions& options) {
    std::error_code problem;
    std::filesystem::create_directories(directory, problem);
    if (problem) {
        return fail(ErrorCode::io, "{}: {}", directory.string(), problem.message());
    }
    Work work(scene, directory, file_system, options);
    for_each_piece(scene.schedule.count, options.threads, [&work](int i) { work.run(i); });
    return work.finish();
}

}  // namespace stormcellar::synth
