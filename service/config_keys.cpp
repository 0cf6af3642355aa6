#include "service/config_keys.h"

#include <algorithm>
#include <system_error>

#include <fmt/format.h>

#include "base/byte_size.h"
#include "base/printable.h"

namespace stormcellar {
namespace {

constexpr std::size_t longest_url = 512;
constexpr std::uint64_t least_bytes = 1'000'000;

}  // namespace

bool is_web_address(std::string_view url) {
    const std::string_view scheme = url.starts_with("https://") ? "https://" : "http://";
    if (!url.starts_with(scheme) || url.size() > longest_url) return false;
    const std::string_view rest = url.substr(scheme.size());
    const auto is_plain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               std::string_view{".-_~:/[]%"}.find(c) != std::string_view::npos;
    };
    return !rest.empty() && rest.front() != '/' && rest.front() != ':' &&
           std::ranges::all_of(rest, is_plain);
}

void read_bytes(TomlTable& table, std::string_view key, std::uint64_t& bytes) {
    if (table.is_text(key)) {
        const auto size = parse_byte_size(*table.text(key));
        if (size && *size >= least_bytes) bytes = *size;
        if (!size) table.complain(key, size.error().message);
        if (size && *size < least_bytes) table.complain(key, "must be at least 1 MB");
    } else if (const auto number = table.number(key, {static_cast<double>(least_bytes), 9e18})) {
        bytes = static_cast<std::uint64_t>(*number);
    }
}

void read_path_beside(TomlTable& table, std::string_view key, const std::filesystem::path& file,
                      std::filesystem::path& path) {
    const auto text = table.text(key);
    if (!text) return;
    if (text->empty()) return table.complain(key, "must not be empty");
    std::error_code ignored;
    path = (std::filesystem::absolute(file, ignored).parent_path() / *text).lexically_normal();
}

void read_log_level(TomlTable root, std::string& level) {
    TomlTable log = root.section("log");
    const auto text = log.text("level");
    if (!text) return;
    if (*text == "debug" || *text == "info" || *text == "warning" || *text == "error") {
        level = *text;
    } else {
        log.complain("level", fmt::format("\"{}\" must be one of debug, info, warning, error",
                                          printable(*text)));
    }
}

Status finish(TomlFile& toml, std::span<const std::string_view> tables_of_others) {
    for (const std::string_view table : tables_of_others)
        toml.root().leave(table);
    return toml.finish();
}

}  // namespace stormcellar
