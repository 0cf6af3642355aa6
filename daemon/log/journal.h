// daemon/log/journal.h -- writes entries with fields to systemd's journal.
//
// An entry is one datagram. A field is NAME=value and a newline. If the value contains a newline,
// the field is NAME, a newline, the value's length (8 bytes, little endian), the value and a
// newline. If an entry is too long for a datagram, it is written to a sealed memory file, and a
// datagram sends the descriptor of that file. We do not call sd_journal_sendv(), because it always
// uses the same socket and reports success even if nobody listens there. Our caller must learn of a
// failure, to write the line somewhere else.
//
// Threads   send() may be called from any thread.
// Source    systemd.io/JOURNAL_NATIVE_PROTOCOL, sd_journal_send(3).
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "stormcellar/base/descriptor.h"

namespace stormcellar::daemon {

inline constexpr const char* journal_socket = "/run/systemd/journal/socket";

// A field of an entry. Its name consists of capital letters, digits and "_" and begins with a
// letter; the journal drops other fields. Its value may be any bytes.
struct JournalField {
    std::string_view name;
    std::string value;
};
[[nodiscard]] std::string journal_entry(std::span<const JournalField> fields);

class Journal {
  public:
    explicit Journal(std::filesystem::path socket);

    // Returns false if the journal does not accept the entry, for example because its socket is
    // missing or has no room within a second.
    [[nodiscard]] bool send(std::string_view entry) const;

  private:
    [[nodiscard]] bool send_as_file(std::string_view entry) const;

    std::filesystem::path path_;
    Descriptor descriptor_;  // closed if no socket could be opened
};

}  // namespace stormcellar::daemon
