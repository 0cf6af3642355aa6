#include "bench/request.h"

#include <algorithm>
#include <cstdlib>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench/table.h"

namespace stormcellar::bench {

namespace fs = std::filesystem;

bool Request::has(std::string_view flag) const {
    return std::find(flags.begin(), flags.end(), flag) != flags.end();
}

std::optional<std::string> Request::value(std::string_view option) const {
    const auto found = values.find(option);
    if (found == values.end()) return std::nullopt;
    return found->second;
}

fs::path Request::data_directory() const {
    const char* configured = std::getenv("STORMCELLAR_DATA");
    return data.value_or(configured != nullptr ? configured : "../shared/data");
}

std::vector<fs::path> Request::volumes() const {
    if (!files.empty()) return files;
    std::vector<fs::path> found;
    for (const char* folder : {"volumes", "sequence-kbgm", "mosaic-northeast"}) {
        std::error_code ignored;
        for (const auto& entry : fs::directory_iterator(data_directory() / folder, ignored))
            found.push_back(entry.path());
    }
    std::sort(found.begin(), found.end());
    return found;
}

ReadRequest read_request(const Program& program, std::span<char* const> arguments) {
    Request request;
    std::string data;
    int threads = 0;
    std::vector<std::string> files;
    CLI::App app{std::string(program.purpose), std::string(program.name)};
    const auto counted = CLI::Range(1, 1000);
    app.add_option("--data", data, "Real volumes (else $STORMCELLAR_DATA, else ../shared/data)")
        ->option_text("DIR")
        ->check(CLI::ExistingDirectory);
    app.add_option("--threads", threads, "This number of threads alone (else 1 and 2)")
        ->option_text("N")
        ->check(counted);
    app.add_option("--runs", request.runs, "The least time of N runs (else 5)")
        ->option_text("N")
        ->check(counted);
    app.add_flag("--json", request.json, "One document {\"machine\", \"rows\"} instead of a table");
    for (const std::string_view flag : program.flags)
        app.add_flag_callback(std::string(flag), [&, flag] { request.flags.emplace_back(flag); });
    for (const std::string_view option : program.values)
        app.add_option_function<std::string>(
            std::string(option),
            [&, option](const std::string& value) { request.values[std::string(option)] = value; });
    if (!program.files.empty()) app.add_option("FILE", files);
    try {
        app.parse(static_cast<int>(arguments.size()), arguments.data());
    } catch (const CLI::CallForHelp&) {
        fmt::print("{}", app.help());
        return {std::nullopt, 0};
    } catch (const CLI::ParseError& error) {
        fmt::print(stderr, "{}: {}\nusage: {}", program.name, error.what(), app.help());
        return {std::nullopt, 2};
    }
    if (!data.empty()) request.data = data;
    if (threads > 0) request.threads = {threads};
    request.files.assign(files.begin(), files.end());
    return {std::move(request), 0};
}

int exit_status(std::string_view program, const Status& done) {
    if (done) return 0;
    fmt::print(stderr, "{}: {}\n", program, done.error().message);
    return done.error().code == ErrorCode::not_found ? 3 : 1;
}

int run_benchmark(const Program& program, int argc, char** argv,
                  const std::function<int(const Request&)>& run) {
    const auto [request, status] =
        read_request(program, std::span(argv, static_cast<std::size_t>(argc)));
    return request ? run(*request) : status;
}

int run_over_files(const Program& program, std::span<char* const> arguments,
                   const MeasureFile& measure) {
    const auto [request, status] = read_request(program, arguments);
    if (!request) return status;
    const std::vector<fs::path> volumes = request->volumes();
    if (volumes.empty()) {
        fmt::print(stderr, "{}: no files: name some, or say --data DIR\n", program.name);
        return 3;
    }
    Table table(request->json);
    for (const fs::path& file : volumes)
        measure(file, *request, table);
    table.finish();
    return 0;
}

}  // namespace stormcellar::bench
