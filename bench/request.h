// bench/request.h -- what the command line of a benchmark asks for.
//
// All benchmarks take the same options: --data DIR, --threads N, --runs N, --json, --help, and
// files. An option that is none of them, or of the program's own, is bad usage.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace stormcellar::bench {

struct Program {
    std::string_view name;
    std::string_view files;                     // what its positional words are, as "[FILE ...]"
    std::string_view purpose;                   // one line
    std::vector<std::string_view> flags = {};   // of its own
    std::vector<std::string_view> values = {};  // options of its own that take a value
};

struct Request {
    int runs = 5;
    std::vector<int> threads = {1, 2};  // to measure with, one behind the other
    bool json = false;
    std::optional<std::filesystem::path> data;  // --data, a directory
    std::vector<std::filesystem::path> files;
    std::vector<std::string> flags;
    std::map<std::string, std::string, std::less<>> values;

    [[nodiscard]] bool has(std::string_view flag) const;
    [[nodiscard]] std::optional<std::string> value(std::string_view option) const;
    // --data, or $STORMCELLAR_DATA, or ../shared/data.
    [[nodiscard]] std::filesystem::path data_directory() const;
    // Those named, else every volume of the data directory, sorted by path.
    [[nodiscard]] std::vector<std::filesystem::path> volumes() const;
};

// None when there is nothing to do: `status` is then what to exit with (0 after --help, 2 after bad
// usage), and what there is to say has been printed.
struct ReadRequest {
    std::optional<Request> request;
    int status = 0;
};
[[nodiscard]] ReadRequest read_request(const Program& program, std::span<char* const> arguments);

class Table;

using MeasureFile =
    std::function<void(const std::filesystem::path&, const Request& request, Table& table)>;

// The body of a benchmark over files: reads the request, has each file measured into a table, and
// prints it. What main() is to return: 2 after bad usage, 3 where there are no files.
[[nodiscard]] int run_over_files(const Program& program, std::span<char* const> arguments,
                                 const MeasureFile& measure);
// The same for a request that has been read.
[[nodiscard]] int measure_files(std::string_view program, const Request& request,
                                const MeasureFile& measure);

}  // namespace stormcellar::bench
