#include "tests/archive/archive_maker.h"

#include <cstring>
#include <stdexcept>

#include <archive.h>
#include <archive_entry.h>

namespace stormcellar::archive {
namespace {

void check(::archive* writer, int code) {
    if (code < ARCHIVE_WARN) throw std::runtime_error(archive_error_string(writer));
}

void put_entry(::archive* writer, const Put& put) {
    ::archive_entry* const entry = archive_entry_new();
    archive_entry_set_pathname(entry, put.name.c_str());
    archive_entry_set_perm(entry, 0644);
    archive_entry_set_mtime(entry, 1'600'000'000, 0);
    switch (put.what) {
        case Put::What::file:
            archive_entry_set_filetype(entry, AE_IFREG);
            archive_entry_set_size(entry, static_cast<la_int64_t>(put.bytes.size()));
            break;
        case Put::What::symlink:
            archive_entry_set_filetype(entry, AE_IFLNK);
            archive_entry_set_symlink(entry, put.target.c_str());
            break;
        case Put::What::hardlink:
            archive_entry_set_filetype(entry, AE_IFREG);
            archive_entry_set_hardlink(entry, put.target.c_str());
            break;
        case Put::What::directory:
            archive_entry_set_filetype(entry, AE_IFDIR);
            break;
        case Put::What::fifo:
            archive_entry_set_filetype(entry, AE_IFIFO);
            break;
    }
    check(writer, archive_write_header(writer, entry));
    if (put.what == Put::What::file && !put.bytes.empty()) {
        archive_write_data(writer, put.bytes.data(), put.bytes.size());
    }
    archive_entry_free(entry);
}

void add_filter(::archive* writer, Kind kind) {
    if (kind == Kind::tar_gz) archive_write_add_filter_gzip(writer);
    if (kind == Kind::tar_bz2) archive_write_add_filter_bzip2(writer);
    if (kind == Kind::tar_compress) archive_write_add_filter_compress(writer);
    if (kind == Kind::tar_xz) archive_write_add_filter_xz(writer);
    if (kind == Kind::tar_zst) archive_write_add_filter_zstd(writer);
}

}  // namespace

std::vector<std::byte> packed(Kind kind, const std::vector<std::byte>& bytes) {
    std::vector<std::byte> whole(2 * bytes.size() + (1 << 20));
    std::size_t used = 0;
    ::archive* const writer = archive_write_new();
    archive_write_set_format_raw(writer);
    add_filter(writer, kind);
    check(writer, archive_write_open_memory(writer, whole.data(), whole.size(), &used));
    put_entry(writer, {"raw", bytes});
    check(writer, archive_write_close(writer));
    archive_write_free(writer);
    whole.resize(used);
    return whole;
}

std::vector<std::byte> make_archive(Kind kind, const std::vector<Put>& puts) {
    std::size_t room = 1 << 20;
    for (const Put& put : puts)
        room += 2 * put.bytes.size() + 4096;
    std::vector<std::byte> bytes(room);
    std::size_t used = 0;
    ::archive* const writer = archive_write_new();
    if (kind == Kind::zip) {
        archive_write_set_format_zip(writer);
    } else {
        archive_write_set_format_pax_restricted(writer);
    }
    add_filter(writer, kind);
    check(writer, archive_write_open_memory(writer, bytes.data(), bytes.size(), &used));
    for (const Put& put : puts)
        put_entry(writer, put);
    check(writer, archive_write_close(writer));
    archive_write_free(writer);
    bytes.resize(used);
    return bytes;
}

std::vector<std::byte> bytes_of(const std::string& text) {
    std::vector<std::byte> bytes(text.size());
    std::memcpy(bytes.data(), text.data(), text.size());
    return bytes;
}

}  // namespace stormcellar::archive
