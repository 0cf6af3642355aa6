#include "web/doors/xml_writer.h"

#include "web/http/answer.h"

namespace stormcellar::web {

XmlWriter::XmlWriter() : text_("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n") {}

void XmlWriter::begin(std::string_view name, Attributes attributes) {
    text_.append(2 * open_.size(), ' ').append("<").append(name);
    for (const auto& [key, value] : attributes)
        text_.append(" ").append(key).append("=\"").append(xml_escaped(value)).append("\"");
}

XmlWriter& XmlWriter::open(std::string_view name, Attributes attributes) {
    begin(name, attributes);
    text_ += ">\n";
    open_.emplace_back(name);
    return *this;
}

XmlWriter& XmlWriter::close() {
    const std::string name = std::move(open_.back());
    open_.pop_back();
    text_.append(2 * open_.size(), ' ').append("</").append(name).append(">\n");
    return *this;
}

XmlWriter& XmlWriter::leaf(std::string_view name, std::string_view text, Attributes attributes) {
    begin(name, attributes);
    text_.append(">").append(xml_escaped(text)).append("</").append(name).append(">\n");
    return *this;
}

XmlWriter& XmlWriter::empty(std::string_view name, Attributes attributes) {
    begin(name, attributes);
    text_ += "/>\n";
    return *this;
}

std::string XmlWriter::take() {
    while (!open_.empty())
        close();
    return std::move(text_);
}

}  // namespace stormcellar::web
