#pragma once

// A scene file's XML tree, with what Mitsuba adds to XML: `<include>`, `<default>` values and `$name`, ids and
// `<alias>`, `<path>`, and words of older versions. Of all headers this one and that of the upgrade include pugixml.

#include <lightswitch/core/file.hpp>
#include <lightswitch/load/find_file.hpp>
#include <lightswitch/load/mitsuba_upgrade.hpp>
#include <lightswitch/load/problems.hpp>
#include <lightswitch/load/xml_parameters.hpp>

#include <pugixml.hpp>

#include <filesystem>
#include <initializer_list>
#include <map>
#include <memory>
#include <set>

namespace lightswitch::detail {

/// A parsed file and those that it includes. Attribute values have `$name` replaced already, and the words of 0.x are
/// those of 3.
///
/// Throws `Error` with the line for malformed or hostile XML: a document type (and with it all entities), more than 64
/// levels, over 16 MiB of text or of replaced values. Goes on, with a problem in the log, after undefined or unused
/// `$name`, ids given twice, and files that cannot be included; with a notice after text between elements.
class XmlFile {
public:
    using Defines = std::map<std::string, std::string>;
    using Paths = std::vector<std::filesystem::path>;

    /// `search_paths` come after those of the file.
    XmlFile(const std::filesystem::path& path, const Defines& defines, const Paths& search_paths, ReadingLog& log);

    pugi::xml_node root() const { return parts_.front()->document.document_element(); }
    /// Where problems and notices go.
    ReadingLog& log() const { return log_; }
    /// File, line and element, such as `<shape type="obj">` or `<float name="fov">`.
    Origin origin(pugi::xml_node node) const;
    /// The elements inside, and in the place of an `<include>` those of the other file.
    std::vector<pugi::xml_node> children(pugi::xml_node node) const;
    /// The element with that id; empty when there is none.
    pugi::xml_node find(const std::string& id) const;
    /// The element that a `<ref>` stands for, of any tag; empty when there is none.
    pugi::xml_node target(pugi::xml_node reference) const { return find(reference.attribute("id").value()); }
    /// The file of that name that `node` speaks of, and which is going to be read. It need not exist.
    std::filesystem::path locate(pugi::xml_node node, const std::string& name) const;
    /// Whether the element was written for Mitsuba 0.x.
    bool is_old(pugi::xml_node node) const { return part(node).is_old; }

    /// Throws unless `node` has each of the `required` attributes. That it has others than the `optional` ones besides,
    /// or one twice, is a problem.
    void check_attributes(pugi::xml_node node, std::initializer_list<std::string_view> required,
                          std::initializer_list<std::string_view> optional = {}) const;
    /// Takes elements inside `node` for a problem.
    void check_childless(pugi::xml_node node) const;

private:
    struct Part {
        std::string file, text;
        LineIndex lines;
        pugi::xml_document document{};
        bool is_old = false;
    };
    static constexpr std::uintmax_t max_bytes = std::uintmax_t(16) << 20;
    static constexpr int max_depth = 64;
    static constexpr std::size_t most_files = 1000;

    const Part& part(pugi::xml_node node) const { return *part_of_.at(node.root()); }
    pugi::xml_node read(const std::filesystem::path& path, int depth);
    void read_version(Part& part);
    void prepare(pugi::xml_node node, int depth);
    void replace(pugi::xml_node node, pugi::xml_attribute attribute);
    void name(pugi::xml_node node);
    void identify(pugi::xml_node node, const std::string& id, pugi::xml_node element);
    void add_path(pugi::xml_node node);
    void include(pugi::xml_node node, int depth);
    bool is_special(pugi::xml_node node) const;

    ReadingLog& log_;
    std::vector<std::unique_ptr<Part>> parts_;
    std::map<pugi::xml_node, const Part*> part_of_;      // by document
    std::map<pugi::xml_node, pugi::xml_node> included_;  // the root of the other file
    Paths paths_of_file_, search_paths_;
    XmlParameters parameters_;
    std::map<std::string, pugi::xml_node> ids_;
    std::size_t bytes_ = 0;
};

inline XmlFile::XmlFile(const std::filesystem::path& path, const Defines& defines, const Paths& search_paths,
                        ReadingLog& log)
    : log_(log), search_paths_(search_paths), parameters_(defines) {
    read(path, 0);
    for (const std::string& name : parameters_.unused())
        log_.problem({parts_[0]->file, 0, {}}, "the parameter " + quote(name) + " is set, but the file does not use it",
                     "it is ignored");
}

/// Reads one file, all of it, and returns its root.
inline pugi::xml_node XmlFile::read(const std::filesystem::path& path, int depth) {
    log_.file(path.string());
    parts_.push_back(std::make_unique<Part>(Part{path.string(), read_file(path, max_bytes - bytes_), LineIndex("")}));
    Part& part = *parts_.back();
    const Origin whole{part.file, 0, {}};
    const std::string& text = part.text;
    part.lines = LineIndex(text);
    bytes_ += text.size();
    // Both would cost pugixml memory far beyond the size of the file, or make it see less than the file.
    if (const std::size_t zero = text.find('\0'); zero != std::string::npos)
        fail({part.file, part.lines.line(zero), {}}, "contains a zero byte: this is not an XML file in UTF-8");
    if (std::count(text.begin(), text.end(), '<') > 1'000'000) fail(whole, "has more than a million tags");

    const unsigned options = pugi::parse_default | pugi::parse_doctype | pugi::parse_fragment;
    const auto result = part.document.load_buffer(text.data(), text.size(), options, pugi::encoding_utf8);
    if (!result)
        fail({part.file, part.lines.line(static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0))), {}},
             std::string("malformed XML: ") + result.description());
    part_of_[part.document] = &part;

    const auto root = part.document.document_element();
    for (const pugi::xml_node node : part.document.children()) {
        if (node.type() == pugi::node_doctype) fail(origin(node), "a document type (DOCTYPE) is not allowed");
        if (node.type() == pugi::node_element && node != root) fail(origin(node), "a second root element");
        if (node == root) read_version(part);
        prepare(node, depth + 1);
    }
    if (!root) fail(whole, "contains no XML element");
    return root;
}

inline void XmlFile::read_version(Part& part) {
    const auto root = part.document.document_element();
    const auto attribute = root.attribute("version");
    if (std::string_view(root.name()) != "scene" && parts_.size() == 1) return;  // which is an error of its own
    const std::string version = attribute.value();
    const auto major = parse_integer(std::string_view(version).substr(0, version.find('.')));
    constexpr const char* instead = "it is read as of version 3";
    if (!attribute) log_.problem(origin(root), "the attribute \"version\" is missing", instead);
    else if (!major || version.find_first_not_of("0123456789.") != std::string::npos)
        log_.problem(origin(root), quote(version) + " is not a version such as \"3.0.0\"", instead);
    else if (*major < 0 || *major > 3)
        log_.problem(origin(root), "is of version " + version + ", but only versions up to 3 of the format are known",
                     instead);
    else part.is_old = *major < 2;
    if (part.is_old) log_.notice(Origin{part.file, 0, {}}, "is upgraded from version " + version + " of the format");
}

inline Origin XmlFile::origin(pugi::xml_node node) const {
    std::string element = "<" + (node.type() == pugi::node_doctype ? std::string("!DOCTYPE") : shown(node.name()));
    for (const char* name : {"type", "name", "id"})
        if (const auto attribute = node.attribute(name)) {
            element += std::string(" ") + name + "=" + quote(attribute.value());
            break;
        }
    // What an upgrade has added has no place of its own.
    pugi::xml_node placed = node;
    while (placed.offset_debug() < 0 && placed.parent()) placed = placed.parent();
    const std::ptrdiff_t offset = placed.offset_debug();
    const Part& in = part(node);
    return {in.file, offset >= 0 ? in.lines.line(static_cast<std::size_t>(offset)) : 0, element + ">"};
}

/// Whether the element says something about the file, and is no part of the scene.
inline bool XmlFile::is_special(pugi::xml_node node) const {
    const std::string_view tag = node.name();
    return tag == "default" || tag == "alias" || tag == "path" || tag == "include";
}

inline std::vector<pugi::xml_node> XmlFile::children(pugi::xml_node node) const {
    std::vector<pugi::xml_node> result;
    for (const pugi::xml_node child : node.children()) {
        if (child.type() != pugi::node_element) continue;
        if (const auto other = included_.find(child); other != included_.end()) {
            if (std::string_view(other->second.name()) != "scene") {
                result.push_back(other->second);
                continue;
            }
            const auto inside = children(other->second);
            result.insert(result.end(), inside.begin(), inside.end());
        } else if (!is_special(child)) {
            result.push_back(child);
        }
    }
    return result;
}

inline pugi::xml_node XmlFile::find(const std::string& id) const {
    const auto found = ids_.find(id);
    return found == ids_.end() ? pugi::xml_node() : found->second;
}

inline std::filesystem::path XmlFile::locate(pugi::xml_node node, const std::string& name) const {
    const auto folder = std::filesystem::path(parts_.front()->file).parent_path();
    Paths folders = paths_of_file_;
    folders.push_back(folder);
    folders.push_back(std::filesystem::path(part(node).file).parent_path());
    folders.insert(folders.end(), search_paths_.begin(), search_paths_.end());
    const FoundFile found = find_file(name, folders, folder);
    if (std::error_code error; std::filesystem::is_regular_file(found.path, error)) log_.file(found.path.string());
    if (!found.exactly)
        log_.notice(origin(node), "there is no " + quote(name) + ": " + quote(found.path.string()) + " is read");
    return found.path;
}

inline void XmlFile::check_attributes(pugi::xml_node node, std::initializer_list<std::string_view> required,
                                      std::initializer_list<std::string_view> optional) const {
    std::set<std::string_view> seen;
    for (const pugi::xml_attribute attribute : node.attributes()) {
        const std::string_view name = attribute.name();
        if (std::find(required.begin(), required.end(), name) == required.end() &&
            std::find(optional.begin(), optional.end(), name) == optional.end())
            log_.problem(origin(node), "unknown attribute " + quote(name), "it is ignored");
        if (!seen.insert(name).second)
            log_.problem(origin(node), "the attribute " + quote(name) + " is given twice", "the first one counts");
    }
    for (const std::string_view name : required)
        if (!seen.contains(name)) fail(origin(node), "the attribute " + quote(name) + " is missing");
}

inline void XmlFile::check_childless(pugi::xml_node node) const {
    for (const pugi::xml_node child : node.children())
        if (child.type() == pugi::node_element)
            log_.problem(origin(child), "does not belong into " + origin(node).element, "it is left out");
}

/// Checks the tree below `node` and replaces `$name` in it, in the order of the file, since a default holds from where
/// it stands.
inline void XmlFile::prepare(pugi::xml_node node, int depth) {
    if (node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata) {
        std::string_view text = node.value();
        const auto parent = node.parent();
        const Origin where = parent.type() == pugi::node_document ? Origin{part(node).file, 0, {}} : origin(parent);
        return log_.notice(where, "unexpected text " + quote(next_word(text)) + " is ignored");
    }
    if (node.type() != pugi::node_element) return;
    if (depth > max_depth) fail(origin(node), "elements are nested more than " + std::to_string(max_depth) + " deep");

    for (const pugi::xml_attribute attribute : node.attributes()) replace(node, attribute);
    if (is_old(node)) upgrade_words(node);
    const std::string_view tag = node.name();
    if (tag == "default")
        log_.attempt("it is ignored", [&] {
            check_attributes(node, {"name", "value"});
            at_place(origin(node),
                     [&] { parameters_.define(node.attribute("name").value(), node.attribute("value").value()); });
        });
    if (tag == "path") log_.attempt("it is ignored", [&] { add_path(node); });
    if (tag == "include") return include(node, depth);
    log_.attempt("the first one counts", [&] { name(node); });
    for (const pugi::xml_node child : node.children()) prepare(child, depth + 1);
    if (is_old(node)) upgrade_parameters(node);
}

/// Replaces `$name` in an attribute.
inline void XmlFile::replace(pugi::xml_node node, pugi::xml_attribute attribute) {
    const std::string_view value = attribute.value();
    if (value.find('$') == std::string_view::npos) return;
    auto [text, unknown] = at_place(origin(node), [&] { return parameters_.replaced(value); });
    for (const std::string& name : unknown)
        log_.problem(
            origin(node),
            "the parameter " + quote("$" + name) + " is not defined: give it a <default> above, or set it when loading",
            "it stays as it is");
    attribute.set_value(text.c_str());
}

/// Takes down the id that an element has or, as an alias, gives.
inline void XmlFile::name(pugi::xml_node node) {
    const std::string id = node.attribute("id").value();
    if (std::string_view(node.name()) == "alias") {
        check_attributes(node, {"id", "as"});
        check_childless(node);
        if (!find(id)) fail(origin(node), "there is no element with the id " + quote(id) + " above");
        identify(node, node.attribute("as").value(), find(id));
    } else if (node.attribute("id") && std::string_view(node.name()) != "ref") {
        identify(node, id, node);
    }
}

/// Lets `id`, which `node` gives, stand for `element`.
inline void XmlFile::identify(pugi::xml_node node, const std::string& id, pugi::xml_node element) {
    const auto [entry, is_new] = ids_.emplace(id, element);
    if (!is_new)
        fail(origin(node),
             "the id " + quote(id) + " is already taken in line " + std::to_string(origin(entry->second).line));
}

/// A `<path>`: searched before those that came before it.
inline void XmlFile::add_path(pugi::xml_node node) {
    check_attributes(node, {"value"});
    const std::filesystem::path path = locate(node, node.attribute("value").value());
    if (std::error_code error; !std::filesystem::is_directory(path, error))
        fail(origin(node), quote(path.string()) + " is not a folder");
    paths_of_file_.insert(paths_of_file_.begin(), path);
}

inline void XmlFile::include(pugi::xml_node node, int depth) {
    check_attributes(node, {"filename"}, {"name"});
    const std::filesystem::path path = locate(node, node.attribute("filename").value());
    if (parts_.size() >= most_files) fail(origin(node), "more than " + std::to_string(most_files) + " files");
    if (std::error_code error; !std::filesystem::is_regular_file(path, error))
        return log_.problem(origin(node), path.string() + ": no such file", "it is left out");
    // Its elements are one level deeper, so that a file cannot include itself without end.
    pugi::xml_node root = at_place(origin(node), [&] { return read(path, depth); });
    if (const auto name = node.attribute("name"); name && !root.attribute("name"))
        root.append_attribute("name").set_value(name.value());
    if (std::string_view(root.name()) != "scene") root.remove_attribute("version");
    included_[node] = root;
}

}  // namespace lightswitch::detail
