// catalog/schema.h -- the tables of a station's database (docs/catalog.md).
#pragma once

namespace stormcellar::catalog {

// SQLite's user_version holds it. A later version of the software has a higher number.
inline constexpr int schema_version = 1;

// "SCat" in SQLite's application_id, so that the database of another program is recognized.
inline constexpr int application_id = 0x53436174;

// Creates version 1. Paths are blobs: a file name may hold any byte except NUL.
inline constexpr const char* create_version_1 = R"sql(
CREATE TABLE file (
    id            INTEGER PRIMARY KEY,
    path          BLOB NOT NULL UNIQUE,
    size_bytes    INTEGER NOT NULL,
    modified_ns   INTEGER NOT NULL,
    content_hash  INTEGER NOT NULL,
    state         TEXT NOT NULL CHECK (state IN ('seen', 'complete', 'partial', 'rejected', 'gone')),
    reason        TEXT NOT NULL,
    registered_ms INTEGER NOT NULL
);
CREATE TABLE volume (
    id            INTEGER PRIMARY KEY,
    start_ms      INTEGER NOT NULL,
    end_ms        INTEGER,
    number        INTEGER CHECK (number BETWEEN 0 AND 999),
    generation    INTEGER NOT NULL,
    vcp           INTEGER,
    sweep_count   INTEGER NOT NULL,
    radial_count  INTEGER NOT NULL,
    complete      INTEGER NOT NULL
);
CREATE UNIQUE INDEX volume_identity ON volume (start_ms, ifnull(number, -1), generation);
CREATE TABLE part (
    file_id       INTEGER NOT NULL REFERENCES file (id) ON DELETE CASCADE,
    ordinal       INTEGER NOT NULL,
    volume_id     INTEGER NOT NULL REFERENCES volume (id),
    PRIMARY KEY (file_id, ordinal)
) WITHOUT ROWID;
CREATE INDEX part_volume ON part (volume_id);
)sql";

}  // namespace stormcellar::catalog
