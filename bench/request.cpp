#include "bench/request.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <system_error>

#include <fmt/format.h>

#include "bench/table.h"
#include "stormcellar/base/result.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

std::string usage_of(const Program& program) {
    std::string flags;
    for (const std::string_view flag : program.flags)
        flags += fmt::format(" [{}]", flag);
    for (const std::string_view option : program.values)
        flags += fmt::format(" [{} VALUE]", option);
    return fmt::format(
        "{}: {}\n"
        "usage: {} [--data DIR] [--threads N] [--runs N] [--json]{} {}\n"
        "  --data DIR   where the real volumes are (else $STORMCELLAR_DATA, else ../shared/data)\n"
        "  --threads N  measure with N threads alone (else 1 and 2), where threads matter\n"
        "  --runs N     take the least time of N runs (else 5)\n"
        "  --json       one document {{\"machine\", \"rows\"}} instead of a table\n",
        program.name, program.purpose, program.name, flags, program.files);
}

Result<int> count_in(std::string_view option, std::string_view text) {
    int count = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    if (error != std::errc{} || end != text.data() + text.size() || count < 1 || count > 1000) {
        return fail(ErrorCode::bad_argument, "{} takes a number from 1 to 1000, not '{}'", option,
                    text);
    }
    return count;
}

Status read_option(std::string_view option, std::string_view value, Request& request) {
    if (option == "--data") {
        std::error_code ignored;
        if (!fs::is_directory(value, ignored))
            return fail(ErrorCode::not_found, "--data: there is no directory '{}'", value);
        request.data = value;
        return {};
    }
    const auto count = count_in(option, value);
    if (!count) return pass_on(count);
    if (option == "--threads") {
        request.threads = {*count};
    } else {
        request.runs = *count;
    }
    return {};
}

Result<Request> parse(const Program& program, std::span<char* const> words) {
    Request request;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string_view word = words[i];
        const auto is_among = [&](const std::vector<std::string_view>& options) {
            return std::find(options.begin(), options.end(), word) != options.end();
        };
        const bool is_own = is_among(program.flags);
        const bool takes_value = is_among(program.values);
        if (word == "--json") {
            request.json = true;
        } else if (is_own) {
            request.flags.emplace_back(word);
        } else if (takes_value || word == "--data" || word == "--threads" || word == "--runs") {
            if (i + 1 == words.size())
                return fail(ErrorCode::bad_argument, "{} takes a value", word);
            const std::string_view value = words[++i];
            if (takes_value) {
                request.values.insert_or_assign(std::string(word), value);
            } else if (auto good = read_option(word, value, request); !good) {
                return pass_on(good);
            }
        } else if (word.starts_with("-")) {
            return fail(ErrorCode::bad_argument, "unknown option {}", word);
        } else {
            request.files.emplace_back(word);
        }
    }
    return request;
}

}  // namespace

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
    const std::span words = arguments.subspan(std::min<std::size_t>(1, arguments.size()));
    const bool help = std::any_of(words.begin(), words.end(), [](const char* word) {
        return std::string_view{word} == "--help";
    });
    if (help) {
        fmt::print("{}", usage_of(program));
        return {std::nullopt, 0};
    }
    auto request = parse(program, words);
    if (!request) {
        fmt::print(stderr, "{}: {}\n{}", program.name, request.error().message, usage_of(program));
        return {std::nullopt, 2};
    }
    return {std::move(*request), 0};
}

int run_over_files(const Program& program, std::span<char* const> arguments,
                   const MeasureFile& measure) {
    const auto [request, status] = read_request(program, arguments);
    if (!request) return status;
    return measure_files(program.name, *request, measure);
}

int measure_files(std::string_view program, const Request& request, const MeasureFile& measure) {
    const std::vector<fs::path> files = request.volumes();
    if (files.empty()) {
        fmt::print(stderr, "{}: no files: name some, or say --data DIR\n", program);
        return 3;
    }
    Table table(request.json);
    for (const fs::path& file : files)
        measure(file, request, table);
    table.finish();
    return 0;
}

}  // namespace stormcellar::bench
