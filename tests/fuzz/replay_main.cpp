// Runs a fuzz target over the files of its corpus and over random mutations of them, without a fuzzing engine: so that
// every compiler and sanitizer preset sees them.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: " << argv[0] << " CORPUS_DIRECTORY\n";
        return 2;
    }
    constexpr int mutations_per_file = 2000;
    std::mt19937_64 random{1};
    std::size_t inputs = 0;
    for (const auto& entry : std::filesystem::directory_iterator{argv[1]}) {
        std::ifstream file{entry.path(), std::ios::binary};
        const std::vector<std::uint8_t> original{std::istreambuf_iterator<char>{file}, {}};
        LLVMFuzzerTestOneInput(original.data(), original.size());
        for (int i = 0; i < mutations_per_file && !original.empty(); ++i) {
            std::vector<std::uint8_t> mutated = original;
            for (std::uint64_t changes = 1 + random() % 4; changes > 0; --changes) {
                const std::size_t at = random() % mutated.size();
                switch (random() % 3) {
                case 0:
                    mutated[at] = static_cast<std::uint8_t>(random());
                    break;
                case 1:
                    mutated.insert(mutated.begin() + static_cast<std::ptrdiff_t>(at),
                                   mutated[random() % mutated.size()]);
                    break;
                default:
                    if (mutated.size() > 1) {
                        mutated.erase(mutated.begin() + static_cast<std::ptrdiff_t>(at));
                    }
                }
            }
            LLVMFuzzerTestOneInput(mutated.data(), mutated.size());
            ++inputs;
        }
        ++inputs;
    }
    std::cout << inputs << " inputs\n";
    return inputs == 0 ? 1 : 0;
}
