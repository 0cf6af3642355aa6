// bench/request.h -- reads the command line of a benchmark.
//
// All benchmarks take the options --data DIR, --threads N, --runs N, --json, --help, and files. Any
// other option, except the program's own, is bad usage.
//
// Threads   One thread at a time.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::bench {

struct Program {
    std::string_view name;
    std::string_view files;                     // "[FILE ...]" if the program takes files
    std::string_view purpose;                   // one line
    std::vector<std::string_view> flags = {};   // the program's own flags
    std::vector<std::string_view> values = {};  // the program's own options with a value
};

struct Request {
    int runs = 5;
    std::vector<int> threads = {1, 2};  // numbers of threads; each is measured
    bool json = false;
    std::optional<std::filesystem::path> data;  // --data, a directory
    std::vector<std::filesystem::path> files;
    std::vector<std::string> flags;
    std::map<std::string, std::string, std::less<>> values;

    [[nodiscard]] bool has(std::string_view flag) const;
    [[nodiscard]] std::optional<std::string> value(std::string_view option) const;
    // Returns --data, or $STORMCELLAR_DATA, or ../shared/data.
    [[nodiscard]] std::filesystem::path data_directory() const;
    // Returns the named files, or if none is named, every volume of the data directory, sorted by
    // path.
    [[nodiscard]] std::vector<std::filesystem::path> volumes() const;
};

// The result of reading a command line. `request` is none after --help or bad usage, which have
// been answered; `status` is then the exit status, 0 or 2.
struct ReadRequest {
    std::optional<Request> request;
    int status = 0;
};
[[nodiscard]] ReadRequest read_request(const Program& program, std::span<char* const> arguments);

// Prints the error, if there is one. Returns the exit status of main(): 0 for success, 3 for
// not_found, 1 for any other error.
[[nodiscard]] int exit_status(std::string_view program, const Status& done);

// Reads the request and calls `run` with it. Returns the exit status of main().
[[nodiscard]] int run_benchmark(const Program& program, int argc, char** argv,
                                const std::function<int(const Request&)>& run);

class Table;

using MeasureFile =
    std::function<void(const std::filesystem::path&, const Request& request, Table& table)>;

// Reads the request, calls `measure` for each file, and prints the table of results. Returns the
// exit status of main(): 2 after bad usage, 3 if there are no files.
[[nodiscard]] int run_over_files(const Program& program, std::span<char* const> arguments,
                                 const MeasureFile& measure);

}  // namespace stormcellar::bench
