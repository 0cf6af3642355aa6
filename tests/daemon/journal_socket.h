// tests/daemon/journal_socket.h -- a socket that receives entries as systemd's journal does. Its
// reader of entries follows the description of the protocol and shares no code with our writer.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <string>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/daemon/datagram_socket.h"

namespace stormcellar::daemon {

using JournalFields = std::map<std::string, std::string>;

// Parses an entry. Returns none if the bytes violate the protocol.
inline std::optional<JournalFields> read_journal_entry(const std::string& bytes) {
    JournalFields fields;
    std::size_t at = 0;
    while (at < bytes.size()) {
        const std::size_t end = bytes.find_first_of("=\n", at);
        if (end == std::string::npos || end == at) return std::nullopt;
        const std::string name = bytes.substr(at, end - at);
        if (name.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_") != std::string::npos)
            return std::nullopt;
        std::string value;
        if (bytes[end] == '=') {
            at = bytes.find('\n', end);
            if (at == std::string::npos) return std::nullopt;
            value = bytes.substr(end + 1, at - end - 1);
        } else {
            if (bytes.size() < end + 9) return std::nullopt;
            std::uint64_t length = 0;
            for (std::size_t byte = 8; byte-- > 0;)
                length = length << 8 | static_cast<unsigned char>(bytes[end + 1 + byte]);
            if (length >= bytes.size() || bytes.size() - end - 9 < length + 1) return std::nullopt;
            value = bytes.substr(end + 9, length);
            at = end + 9 + length;
            if (bytes[at] != '\n') return std::nullopt;
        }
        fields[name] = value;
        ++at;
    }
    return fields;
}

class JournalSocket : public DatagramSocket {
  public:
    using DatagramSocket::DatagramSocket;

    // Returns true if the last entry came as a file.
    [[nodiscard]] bool was_file() const { return was_file_; }

    // Returns the bytes of the next entry; none if no entry waits.
    std::optional<std::string> receive() {
        if (!is_ready(0)) return std::nullopt;
        std::string bytes(1 << 20, '\0');
        alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
        iovec part{bytes.data(), bytes.size()};
        msghdr message{};
        message.msg_iov = &part;
        message.msg_iovlen = 1;
        message.msg_control = control.data();
        message.msg_controllen = control.size();
        const ssize_t got = ::recvmsg(number(), &message, MSG_CMSG_CLOEXEC);
        if (got < 0) return std::nullopt;
        bytes.resize(static_cast<std::size_t>(got));
        const cmsghdr* header = CMSG_FIRSTHDR(&message);
        was_file_ = header != nullptr;
        if (!was_file_) return bytes;
        int file = -1;
        std::memcpy(&file, CMSG_DATA(header), sizeof file);
        return read_sealed(Descriptor(file));
    }
    std::optional<JournalFields> receive_fields() {
        const auto bytes = receive();
        return bytes ? read_journal_entry(*bytes) : std::nullopt;
    }

  private:
    // Like the journal, refuses a file that somebody could still change.
    static std::optional<std::string> read_sealed(const Descriptor& file) {
        constexpr int needed = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE;
        if ((::fcntl(file.number(), F_GET_SEALS) & needed) != needed) return std::nullopt;
        struct stat facts {};
        if (::fstat(file.number(), &facts) != 0) return std::nullopt;
        std::string bytes(static_cast<std::size_t>(facts.st_size), '\0');
        if (::pread(file.number(), bytes.data(), bytes.size(), 0) != facts.st_size)
            return std::nullopt;
        return bytes;
    }

    bool was_file_ = false;
};

}  // namespace stormcellar::daemon
