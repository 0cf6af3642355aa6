#include "web/http/read_request.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "base/host_field.h"
#include "web/http/client_address.h"

namespace stormcellar::web {
namespace {

std::string lower_case(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) {
        return c < 0x80 ? static_cast<char>(std::tolower(c)) : static_cast<char>(c);
    });
    return out;
}

// Returns the value of `name` in the last element of a Forwarded field. The trusted proxy added
// this element.
std::string forwarded_value(std::string_view field, std::string_view name) {
    const std::size_t comma = field.rfind(',');
    std::string_view last = comma == std::string_view::npos ? field : field.substr(comma + 1);
    while (!last.empty()) {
        const std::size_t end = std::min(last.find(';'), last.size());
        std::string_view pair = last.substr(0, end);
        last.remove_prefix(std::min(end + 1, last.size()));
        while (pair.starts_with(' '))
            pair.remove_prefix(1);
        const std::size_t equals = pair.find('=');
        if (equals == std::string_view::npos || lower_case(pair.substr(0, equals)) != name)
            continue;
        std::string_view value = pair.substr(equals + 1);
        if (value.size() >= 2 && value.front() == '"' && value.back() == '"')
            value = value.substr(1, value.size() - 2);
        return std::string(value);
    }
    return {};
}

std::string last_of(std::string_view list) {
    const std::size_t comma = list.rfind(',');
    if (comma != std::string_view::npos) list.remove_prefix(comma + 1);
    while (list.starts_with(' '))
        list.remove_prefix(1);
    while (list.ends_with(' '))
        list.remove_suffix(1);
    return std::string(list);
}

// Statements of a trusted proxy about the client, and about the address that the client used.
struct ForwardedFacts {
    std::string client, scheme, host;
};
ForwardedFacts facts_of_forwarded(std::string_view field) {
    return {forwarded_value(field, "for"), forwarded_value(field, "proto"),
            forwarded_value(field, "host")};
}
ForwardedFacts facts_of_x_forwarded(const Request& request) {
    const auto last_in = [&](std::string_view name) {
        const auto field = request.header(name);
        return field ? last_of(*field) : std::string{};
    };
    return {last_in("X-Forwarded-For"), last_in("X-Forwarded-Proto"), last_in("X-Forwarded-Host")};
}

// Returns what the proxy says. A proxy writes one kind of field. Unless configured otherwise, it
// passes on the other kind as its client sent it. So if both kinds are present and name different
// clients, neither is believed, and the proxy counts as the client.
ForwardedFacts forwarded_facts(const Request& request) {
    const auto field = request.header("Forwarded");
    ForwardedFacts facts = facts_of_x_forwarded(request);
    if (!field) return facts;
    ForwardedFacts standard = facts_of_forwarded(*field);
    if (facts.client.empty()) return standard;
    return read_address(facts.client) == read_address(standard.client) ? facts : ForwardedFacts{};
}

bool is_safe_host(std::string_view host) {
    return !host.empty() && host.size() <= 255 && std::all_of(host.begin(), host.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
               std::string_view{".-:[]_"}.find(c) != std::string_view::npos;
    });
}

std::size_t count_of(const Fields& headers, std::string_view name) {
    return static_cast<std::size_t>(
        std::count_if(headers.begin(), headers.end(),
                      [&](const auto& field) { return lower_case(field.first) == name; }));
}

std::optional<Refusal> check_host(const RawRequest& raw, const Request& request,
                                  const Identity& identity) {
    const std::size_t hosts = count_of(raw.headers, "host");
    if (hosts > 1) return Refusal{400, "The request has several Host fields."};
    if (hosts == 0) {
        // HTTP/1.0 has no Host field, and browsers do not use it.
        if (raw.is_http_1_0) return std::nullopt;
        return Refusal{400, "The request has no Host field."};
    }
    if (!names_us(*request.header("Host"), identity)) {
        return Refusal{
            421,
            "This server does not answer under the name in the Host field. Its owner can "
            "add the name to [web] names, or with --allow-host."};
    }
    return std::nullopt;
}

std::string base_of(const RawRequest& raw, const Request& request, const Identity& identity,
                    bool is_proxied) {
    if (!identity.public_address.empty()) return identity.public_address;
    std::string scheme = "http", host = request.header("Host").value_or("localhost");
    if (is_proxied) {
        const ForwardedFacts facts = forwarded_facts(request);
        if (facts.scheme == "https") scheme = "https";
        if (is_safe_host(facts.host) && names_us(facts.host, identity)) host = facts.host;
    }
    if (raw.is_http_1_0 && !is_safe_host(host)) host = "localhost";
    return scheme + "://" + host + identity.prefix;
}

}  // namespace

Identity identity_of(const ServerOptions& options) {
    Identity identity;
    // Store the name in the form that the field Host has.
    const auto add_name = [&](const std::string& name) {
        const bool is_v6 = name.find(':') != std::string::npos;
        identity.names.insert(lower_case(is_v6 ? fmt::format("[{}]", name) : name));
    };
    for (const std::string& name : options.names)
        add_name(name);
    for (const ListenAddress& listen : options.listen)
        add_name(listen.address);
    // Normalize addresses, because an IPv6 address can be written in several forms.
    for (const std::string& proxy : options.trusted_proxies)
        identity.proxies.insert(read_address(proxy).value_or(proxy));
    identity.public_address = options.public_address;
    while (identity.public_address.ends_with('/'))
        identity.public_address.pop_back();
    identity.prefix = options.prefix;
    while (identity.prefix.ends_with('/'))
        identity.prefix.pop_back();
    // The host of the public address is also a name of the server.
    const std::size_t scheme = identity.public_address.find("://");
    if (scheme != std::string::npos) {
        const std::string_view rest = std::string_view{identity.public_address}.substr(scheme + 3);
        identity.names.insert(lower_case(name_in_host_field(rest.substr(0, rest.find('/')))));
    }
    return identity;
}

bool names_us(std::string_view host, const Identity& identity) {
    if (!is_safe_host(host)) return false;
    if (is_loopback_host(host)) return true;
    const std::string name = lower_case(name_in_host_field(host));
    if (name.empty()) return false;
    return identity.names.contains(name) || identity.names.contains("*");
}

Reading read_request(const RawRequest& raw, const Identity& identity) {
    Reading reading;
    Request& request = reading.request;
    const auto refuse = [&](unsigned status, std::string reason) {
        reading.refusal = Refusal{status, std::move(reason)};
        return reading;
    };
    request.headers = raw.headers;
    request.client = raw.client;
    if (const auto refusal = check_host(raw, request, identity)) {
        reading.refusal = refusal;
        return reading;
    }
    const bool is_proxied = identity.proxies.contains(raw.client);
    // If the proxy gives a name such as "unknown" instead of an address, the proxy counts as the
    // client.
    if (is_proxied) {
        if (auto client = read_address(forwarded_facts(request).client))
            request.client = *std::move(client);
    }
    if (raw.method == "HEAD") {
        request.verb = Verb::head;
    } else if (raw.method == "OPTIONS") {
        request.verb = Verb::options;
    } else if (raw.method != "GET") {
        return refuse(405, "This server answers GET, HEAD and OPTIONS: it only reads.");
    }
    if (count_of(raw.headers, "transfer-encoding") > 0 ||
        request.header("Content-Length").value_or("0") != "0")
        return refuse(413, "A request to this server has no body.");
    if (request.verb == Verb::options && raw.target == "*") {
        request.path = "/";
        request.base = base_of(raw, request, identity, is_proxied);
        return reading;
    }
    std::string_view target = raw.target;
    // A target may be a full URL (RFC 9112 section 3.2.2).
    if (target.starts_with("http://") || target.starts_with("https://")) {
        target.remove_prefix(target.find("://") + 3);
        const std::size_t slash = target.find('/');
        if (slash == std::string_view::npos || !names_us(target.substr(0, slash), identity))
            return refuse(421, "This server is not at the address in the request line.");
        target.remove_prefix(slash);
    }
    const std::size_t mark = std::min(target.find('?'), target.size());
    auto path = decoded_path(target.substr(0, mark));
    if (!path) return refuse(400, "The path of the request cannot be read.");
    auto query = decoded_query(target.substr(std::min(mark + 1, target.size())));
    if (!query) return refuse(400, "The query of the request cannot be read.");
    if (!identity.prefix.empty() &&
        (*path == identity.prefix || path->starts_with(identity.prefix + "/"))) {
        path->erase(0, identity.prefix.size());
        if (path->empty()) *path = "/";
    }
    request.path = *std::move(path);
    request.query = *std::move(query);
    request.base = base_of(raw, request, identity, is_proxied);
    return reading;
}

}  // namespace stormcellar::web
