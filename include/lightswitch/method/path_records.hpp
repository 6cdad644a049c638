#pragma once

// What light paths leave behind for a later pass.

#include <lightswitch/core/parallel.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace lightswitch {

/// Records of light paths, in the order of the paths' numbers whatever the threads. `start` and `push` are for the
/// function that runs in `Frame::paths` (with its usual share of work `per_unit`); everything else is for one thread
/// before or after.
template <class Record, std::uint64_t per_unit>
class PathRecords {
public:
    /// Forgets everything and makes room for paths with numbers in [0, n).
    void reset(std::uint64_t n) {
        units_.resize(static_cast<std::size_t>((n + per_unit - 1) / per_unit));
        for (Unit& unit : units_) {
            unit.records.clear();
            unit.first.clear();
        }
    }

    /// The path with that number begins. To be called once for each, before its records.
    void start(std::uint64_t path) {
        Unit& unit = units_[path / per_unit];
        unit.first.push_back(static_cast<std::uint32_t>(unit.records.size()));
    }
    void push(std::uint64_t path, const Record& record) { units_[path / per_unit].records.push_back(record); }

    /// The records of one path.
    std::span<const Record> of(std::uint64_t path) const {
        const Unit& unit = units_[path / per_unit];
        const std::size_t i = path % per_unit, begin = unit.first[i];
        const std::size_t end = i + 1 < unit.first.size() ? unit.first[i + 1] : unit.records.size();
        return {unit.records.data() + begin, end - begin};
    }

    std::size_t size() const {
        std::size_t sum = 0;
        for (const Unit& unit : units_) sum += unit.records.size();
        return sum;
    }

    /// Sets `items` to `make(record)` of every record.
    template <class Item>
    void list(std::vector<Item>& items, const Executor auto& executor, const auto& make) const {
        std::vector<std::size_t> begin(units_.size());
        std::size_t sum = 0;
        for (std::size_t i = 0; i < units_.size(); ++i) {
            begin[i] = sum;
            sum += units_[i].records.size();
        }
        items.resize(sum);
        executor.for_each(units_.size(), [&](std::size_t i) {
            std::size_t to = begin[i];
            for (const Record& record : units_[i].records) items[to++] = make(record);
        });
    }

private:
    struct Unit {
        std::vector<Record> records;
        std::vector<std::uint32_t> first;  // of each path
    };
    std::vector<Unit> units_;
};

}  // namespace lightswitch
