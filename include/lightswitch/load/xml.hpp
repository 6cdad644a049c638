#pragma once

// A scene file's XML tree, with what Mitsuba adds to XML: `<default>` values and `$name`, ids and `<alias>`. The only
// header that includes pugixml.

#include <lightswitch/core/file.hpp>
#include <lightswitch/load/text.hpp>

#include <pugixml.hpp>

#include <filesystem>
#include <initializer_list>
#include <map>
#include <set>

namespace lightswitch::detail {

/// A parsed file. Attribute values have `$name` replaced already.
///
/// Throws `Error` with the line for malformed or hostile XML: a document type (and with it all entities), text between
/// elements, more than 64 levels, over 16 MiB of text or of replaced values, undefined or unused `$name`, ids given
/// twice.
class XmlFile {
public:
    XmlFile(const std::filesystem::path& path, const std::map<std::string, std::string>& defines);

    pugi::xml_node root() const { return document_.document_element(); }
    /// File, line and element, such as `<shape type="obj">` or `<float name="fov">`.
    Origin origin(pugi::xml_node node) const;
    /// The element with that id; empty when there is none.
    pugi::xml_node find(const std::string& id) const;
    /// The element with that tag that a `<ref>` stands for. Throws when there is none.
    pugi::xml_node target(pugi::xml_node reference, const std::string& tag) const;
    /// Throws unless `node` has each of the `required` attributes, at most the `optional` ones besides, and none twice.
    void check_attributes(pugi::xml_node node, std::initializer_list<std::string_view> required,
                          std::initializer_list<std::string_view> optional = {}) const;
    /// Throws when there is an element inside `node`.
    void check_childless(pugi::xml_node node) const;

private:
    static constexpr std::uintmax_t max_bytes = std::uintmax_t(16) << 20;
    static constexpr int max_depth = 64;
    static constexpr std::size_t longest_name = 100;
    static constexpr std::string_view name_characters =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";

    void prepare(pugi::xml_node node, int depth);
    std::string substituted(pugi::xml_node node, std::string_view value);
    void define(pugi::xml_node node);
    void identify(pugi::xml_node node, const std::string& id, pugi::xml_node element);

    std::string file_, text_;
    LineIndex lines_;
    pugi::xml_document document_;
    std::map<std::string, std::string> values_;
    std::set<std::string> unused_;
    std::map<std::string, pugi::xml_node> ids_;
    std::size_t substituted_bytes_ = 0;
};

inline XmlFile::XmlFile(const std::filesystem::path& path, const std::map<std::string, std::string>& defines)
    : file_(path.string()), text_(read_file(path, max_bytes)), lines_(text_), values_(defines) {
    for (const auto& [name, value] : defines) unused_.insert(name);
    // Both would cost pugixml memory far beyond the size of the file, or make it see less than the file.
    if (const std::size_t zero = text_.find('\0'); zero != std::string::npos)
        fail({file_, lines_.line(zero), {}}, "contains a zero byte: this is not an XML file in UTF-8");
    if (std::count(text_.begin(), text_.end(), '<') > 1'000'000) fail({file_, 0, {}}, "has more than a million tags");

    const unsigned options = pugi::parse_default | pugi::parse_doctype | pugi::parse_fragment;
    const auto result = document_.load_buffer(text_.data(), text_.size(), options, pugi::encoding_utf8);
    if (!result)
        fail({file_, lines_.line(static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0))), {}},
             std::string("malformed XML: ") + result.description());

    for (const pugi::xml_node node : document_.children()) {
        if (node.type() == pugi::node_doctype) fail(origin(node), "a document type (DOCTYPE) is not allowed");
        if (node.type() == pugi::node_element && node != root()) fail(origin(node), "a second root element");
        prepare(node, 1);
    }
    if (!root()) fail({file_, 0, {}}, "contains no XML element");
    if (!unused_.empty())
        fail({file_, 0, {}}, "the parameter " + quote(*unused_.begin()) + " is set, but the file does not use it");
}

inline Origin XmlFile::origin(pugi::xml_node node) const {
    std::string element = "<" + (node.type() == pugi::node_doctype ? std::string("!DOCTYPE") : shown(node.name()));
    for (const char* name : {"type", "name", "id"})
        if (const auto attribute = node.attribute(name)) {
            element += std::string(" ") + name + "=" + quote(attribute.value());
            break;
        }
    const std::ptrdiff_t offset = node.offset_debug();
    return {file_, offset >= 0 ? lines_.line(static_cast<std::size_t>(offset)) : 0, element + ">"};
}

inline pugi::xml_node XmlFile::find(const std::string& id) const {
    const auto found = ids_.find(id);
    return found == ids_.end() ? pugi::xml_node() : found->second;
}

inline pugi::xml_node XmlFile::target(pugi::xml_node reference, const std::string& tag) const {
    check_attributes(reference, {"id"}, {"name"});
    check_childless(reference);
    const std::string id = reference.attribute("id").value();
    const pugi::xml_node found = find(id);
    if (!found) fail(origin(reference), "there is no element with the id " + quote(id));
    if (found.name() != tag)
        fail(origin(reference), "refers to " + origin(found).element + ", but only a <" + tag + "> can be referred to");
    return found;
}

inline void XmlFile::check_attributes(pugi::xml_node node, std::initializer_list<std::string_view> required,
                                      std::initializer_list<std::string_view> optional) const {
    std::set<std::string_view> seen;
    for (const pugi::xml_attribute attribute : node.attributes()) {
        const std::string_view name = attribute.name();
        if (std::find(required.begin(), required.end(), name) == required.end() &&
            std::find(optional.begin(), optional.end(), name) == optional.end())
            fail(origin(node), "unknown attribute " + quote(name));
        if (!seen.insert(name).second) fail(origin(node), "the attribute " + quote(name) + " is given twice");
    }
    for (const std::string_view name : required)
        if (!seen.contains(name)) fail(origin(node), "the attribute " + quote(name) + " is missing");
}

inline void XmlFile::check_childless(pugi::xml_node node) const {
    for (const pugi::xml_node child : node.children())
        if (child.type() == pugi::node_element) fail(origin(child), "does not belong into " + origin(node).element);
}

/// Checks the tree below `node` and replaces `$name` in it, in the order of the file, since a default holds from where
/// it stands.
inline void XmlFile::prepare(pugi::xml_node node, int depth) {
    if (node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata) {
        std::string_view text = node.value();
        const auto parent = node.parent();
        fail(parent == document_ ? Origin{file_, 0, {}} : origin(parent), "unexpected text " + quote(next_word(text)));
    }
    if (node.type() != pugi::node_element) return;
    if (depth > max_depth) fail(origin(node), "elements are nested more than " + std::to_string(max_depth) + " deep");

    for (pugi::xml_attribute attribute : node.attributes())
        if (const std::string_view value = attribute.value(); value.find('$') != std::string_view::npos)
            attribute.set_value(substituted(node, value).c_str());
    if (std::string_view(node.name()) == "default") define(node);
    const std::string id = node.attribute("id").value();
    if (std::string_view(node.name()) == "alias") {
        check_attributes(node, {"id", "as"});
        check_childless(node);
        if (!find(id)) fail(origin(node), "there is no element with the id " + quote(id) + " above");
        identify(node, node.attribute("as").value(), find(id));
    } else if (node.attribute("id") && std::string_view(node.name()) != "ref") {
        identify(node, id, node);
    }
    for (const pugi::xml_node child : node.children()) prepare(child, depth + 1);
}

/// Lets `id`, which `node` gives, stand for `element`.
inline void XmlFile::identify(pugi::xml_node node, const std::string& id, pugi::xml_node element) {
    const auto [entry, is_new] = ids_.emplace(id, element);
    if (!is_new)
        fail(origin(node),
             "the id " + quote(id) + " is already taken in line " + std::to_string(origin(entry->second).line));
}

inline void XmlFile::define(pugi::xml_node node) {
    check_attributes(node, {"name", "value"});
    const std::string name = node.attribute("name").value();
    if (name.empty() || name.find_first_not_of(name_characters) != std::string::npos || name.size() > longest_name)
        fail(origin(node),
             "the name must be 1 to " + std::to_string(longest_name) + " letters, digits and underscores");
    values_.emplace(name, node.attribute("value").value());
}

/// As in Mitsuba, the longest known name that fits is meant, and `\$` is a dollar sign.
inline std::string XmlFile::substituted(pugi::xml_node node, std::string_view value) {
    std::string result;
    while (!value.empty()) {
        const std::size_t dollar = value.find('$');
        const std::string_view before = value.substr(0, dollar);
        result += before;
        if (dollar == std::string_view::npos) break;
        value.remove_prefix(dollar + 1);
        if (before.ends_with('\\')) {
            result.back() = '$';
            continue;
        }
        const std::string_view word = value.substr(0, value.find_first_not_of(name_characters));
        std::size_t length = std::min(word.size(), longest_name);
        auto match = values_.end();
        for (; length > 0 && match == values_.end(); --length)
            match = values_.find(std::string(value.substr(0, length)));
        if (match == values_.end())
            fail(origin(node), "the parameter " + quote("$" + std::string(word)) +
                                   " is not defined: give it a <default> above, or set it when loading");
        unused_.erase(match->first);
        value.remove_prefix(match->first.size());
        result += match->second;
        substituted_bytes_ += match->second.size();
        if (substituted_bytes_ > max_bytes)
            fail(origin(node), "replacing parameters makes the file longer than 16 MiB");
    }
    return result;
}

}  // namespace lightswitch::detail
