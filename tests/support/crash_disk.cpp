#include "support/crash_disk.hpp"

#include <algorithm>

namespace linefeed::test {

namespace {

void apply_change(std::string& content, const CrashDisk::Change& change) {
    if (!change.data) {
        content.resize(change.offset);
        return;
    }
    if (content.size() < change.offset + change.data->size()) {
        content.resize(change.offset + change.data->size());
    }
    std::copy(change.data->begin(), change.data->end(), content.begin() + static_cast<std::ptrdiff_t>(change.offset));
}

/// Which changes survive, decided one after the other.
class Lottery {
public:
    Lottery(Survival survival, std::uint64_t seed, std::size_t changes)
        : survival_(survival)
        , chance_(seed)
        , edge_(chance_.below(changes + 1))
        , sector_bytes_(chance_.below(2) == 0 ? 512 : 4096)
        , kept_in_8_(std::uint64_t{1} << chance_.below(3)) // mostly lost … half kept
        , mostly_kept_(chance_.below(2) == 0) {}

    void apply_what_survives(std::string& content, const CrashDisk::Change& change) {
        const std::size_t index = index_++;
        switch (survival_) {
        case Survival::nothing:
            return;
        case Survival::everything:
            apply_change(content, change);
            return;
        case Survival::prefix:
            if (index < edge_) {
                apply_change(content, change);
            } else if (index == edge_) {
                tear(content, change);
            }
            return;
        case Survival::subset:
            if (kept()) {
                apply_change(content, change);
            }
            return;
        case Survival::torn:
            tear(content, change);
            return;
        }
    }

    [[nodiscard]] bool name_survives() {
        const std::size_t index = index_++;
        switch (survival_) {
        case Survival::nothing:
            return false;
        case Survival::everything:
            return true;
        case Survival::prefix:
            return index < edge_;
        case Survival::subset:
        case Survival::torn:
            return kept();
        }
        return false;
    }

private:
    [[nodiscard]] bool kept() { return (chance_.below(8) < kept_in_8_) != mostly_kept_; }

    void tear(std::string& content, const CrashDisk::Change& change) {
        if (!change.data) {
            if (kept()) {
                apply_change(content, change);
            }
            return;
        }
        std::uint64_t at = 0;
        while (at < change.data->size()) {
            const std::uint64_t sector_end = ((change.offset + at) / sector_bytes_ + 1) * sector_bytes_ - change.offset;
            const std::uint64_t end = std::min<std::uint64_t>(sector_end, change.data->size());
            if (kept()) {
                const bool cut = chance_.below(8) == 0; // the sector itself was not finished
                const std::uint64_t bytes = cut ? chance_.below(end - at) : end - at;
                apply_change(content, {change.order, change.offset + at, change.data->substr(at, bytes)});
            }
            at = end;
        }
    }

    Survival survival_;
    Chance chance_;
    std::size_t edge_;
    std::uint64_t sector_bytes_;
    std::uint64_t kept_in_8_;
    bool mostly_kept_;
    std::size_t index_ = 0;
};

} // namespace

std::uint64_t Chance::next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ULL);
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31U);
}

CrashDisk::FilePtr CrashDisk::find(const std::string& path) const {
    const auto found = names_.find(path);
    return found == names_.end() ? nullptr : found->second;
}

CrashDisk::FilePtr CrashDisk::create(const std::string& path) {
    const auto file = std::make_shared<File>();
    names_[path] = file;
    unsynced_names_.push_back({order_++, path, file});
    return file;
}

void CrashDisk::remove(const std::string& path) {
    const auto found = names_.find(path);
    if (found != names_.end()) {
        used_bytes_ -= found->second->content.size();
        found->second->temporary = true; // whoever has it open still sees it
        names_.erase(found);
        unsynced_names_.push_back({order_++, path, nullptr});
    }
}

void CrashDisk::sync_directory() {
    durable_names_ = names_;
    unsynced_names_.clear();
}

void CrashDisk::write(File& file, std::uint64_t offset, std::string_view data) {
    const std::size_t before = file.content.size();
    Change change{order_++, offset, std::string{data}};
    apply_change(file.content, change);
    if (!file.temporary) {
        used_bytes_ += file.content.size() - before;
        file.unsynced.push_back(std::move(change));
    }
}

void CrashDisk::truncate(File& file, std::uint64_t size) {
    if (!file.temporary) {
        used_bytes_ = used_bytes_ - file.content.size() + size;
        file.unsynced.push_back({order_++, size, std::nullopt});
    }
    file.content.resize(size);
}

void CrashDisk::sync(File& file) {
    for (const Change& change : file.unsynced) {
        apply_change(file.durable, change);
    }
    file.unsynced.clear();
}

void CrashDisk::forget_unsynced(File& file) {
    file.unsynced.clear();
}

std::size_t CrashDisk::unsynced_changes() const {
    std::size_t changes = unsynced_names_.size();
    for (const auto& [path, file] : names_) {
        changes += file->unsynced.size();
    }
    return changes;
}

DiskImage CrashDisk::image(Survival survival, std::uint64_t seed) const {
    // Every file that a surviving name may lead to, and the changes to all of them in the order in which they were
    // made.
    std::map<File*, std::string> contents;
    struct Pending {
        std::uint64_t order;
        File* file;
        const Change* change;
        const NameChange* name;
    };
    std::vector<Pending> pending;
    const auto add_file = [&](const FilePtr& file) {
        if (file != nullptr && contents.try_emplace(file.get(), file->durable).second) {
            for (const Change& change : file->unsynced) {
                pending.push_back({change.order, file.get(), &change, nullptr});
            }
        }
    };
    for (const auto& [path, file] : durable_names_) {
        add_file(file);
    }
    for (const NameChange& change : unsynced_names_) {
        add_file(change.file);
        pending.push_back({change.order, nullptr, nullptr, &change});
    }
    std::sort(pending.begin(), pending.end(), [](const Pending& a, const Pending& b) { return a.order < b.order; });

    std::map<std::string, FilePtr> names = durable_names_;
    Lottery lottery{survival, seed, pending.size()};
    for (const Pending& one : pending) {
        if (one.change != nullptr) {
            lottery.apply_what_survives(contents.at(one.file), *one.change);
        } else if (lottery.name_survives()) {
            if (one.name->file != nullptr) {
                names[one.name->path] = one.name->file;
            } else {
                names.erase(one.name->path);
            }
        }
    }
    DiskImage image;
    for (const auto& [path, file] : names) {
        image[path] = contents.at(file.get());
    }
    return image;
}

void CrashDisk::load(const DiskImage& image) {
    names_.clear();
    unsynced_names_.clear();
    used_bytes_ = 0;
    for (const auto& [path, content] : image) {
        const auto file = std::make_shared<File>();
        file->content = file->durable = content;
        used_bytes_ += content.size();
        names_[path] = file;
    }
    durable_names_ = names_;
}

void CrashDisk::release_all() {
    for (const auto& [path, file] : names_) {
        file->sharing = {};
    }
}

} // namespace linefeed::test
