// cli/serve/served_files.h -- grids the files of a command line and serves them until Ctrl-C.
//
// Threads   One thread at a time.
// Errors    See each function.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "cli/serve/scratch_cellar.h"
#include "service/signals.h"
#include "stormcellar/base/result.h"
#include "web/service/web_service.h"

namespace stormcellar::cli {

// Ingests the files one after another.
class ServedFiles {
  public:
    // Ingests files until one of them has given grids, so that the page shows something from the
    // start. Decoding and gridding use `threads` threads; 0: one for each processor. Errors: those
    // of files_to_serve() and ScratchCellar; not_found if no file gives grids.
    static Result<std::unique_ptr<ServedFiles>> take(const std::vector<std::string>& names,
                                                     int threads);
    ServedFiles(const ServedFiles&) = delete;
    ServedFiles& operator=(const ServedFiles&) = delete;
    ~ServedFiles();

    // Starts a thread that ingests the remaining files and then grids the derived moments of all
    // files.
    void take_rest();
    [[nodiscard]] const ScratchCellar& cellar() const { return *cellar_; }

  private:
    ServedFiles(std::unique_ptr<ScratchCellar> cellar, std::vector<std::filesystem::path> files)
        : cellar_(std::move(cellar)), files_(std::move(files)) {}
    Status take_first();
    Result<std::size_t> take_next();

    std::unique_ptr<ScratchCellar> cellar_;
    std::vector<std::filesystem::path> files_;
    std::size_t next_ = 0;
    // Files that gave grids. For a volume in chunks, the entry is the chunk that completed it.
    std::vector<std::filesystem::path> gridded_;
    std::atomic<bool> is_stopping_{false};
    std::thread thread_;
};

// Makes the setup of a server serve these files. No further volumes come, so no station counts as
// silent.
void serve_files(const ServedFiles& files, web::WebSetup& setup);

// Waits until a signal asks the program to end.
void serve_until_signal(const Signals& signals, web::WebService& service);

}  // namespace stormcellar::cli
