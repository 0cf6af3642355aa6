// catalog/sql_values.h -- converts between SQLite's values and the types of the catalog. Used only
// inside the catalog room.
//
// Threads   Functions without state.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <SQLiteCpp/SQLiteCpp.h>

#include "stormcellar/base/utc_time.h"

namespace stormcellar::catalog {

inline void bind_path(SQLite::Statement& statement, int index, const std::filesystem::path& path) {
    const std::string& bytes = path.native();
    statement.bind(index, bytes.data(), static_cast<int>(bytes.size()));
}

inline std::optional<std::int64_t> milliseconds(const std::optional<UtcTime>& time) {
    if (!time) return std::nullopt;
    return time->time_since_epoch().count();
}

inline UtcTime time_of(std::int64_t ms) {
    return UtcTime{std::chrono::milliseconds{ms}};
}

inline std::optional<UtcTime> optional_time(const SQLite::Column& column) {
    if (column.isNull()) return std::nullopt;
    return time_of(column.getInt64());
}

inline std::optional<int> optional_int(const SQLite::Column& column) {
    if (column.isNull()) return std::nullopt;
    return column.getInt();
}

}  // namespace stormcellar::catalog
