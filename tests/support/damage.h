/// \file damage.h
/// Malformed files from good ones, the same from one run to the next.
#pragma once

#include "support/test_files.h"

#include <hex/base/error.h>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <random>
#include <string>

namespace hex::test {

/// The file with a few bytes changed, left out, said twice, or replaced by numbers that are hard to swallow.
inline std::string damaged(std::string text, std::mt19937& random, int changes) {
    static constexpr std::array numbers = {"9999999999", "-1",         "0",         "nan",
                                           "1e999",      "4294967295", "2147483648"};
    for (int change = 0; change < changes && !text.empty(); ++change) {
        const std::size_t at = random() % text.size();
        switch (random() % 5) {
            case 0:
                text[at] = static_cast<char>(random());
                break;
            case 1:
                text.erase(at, random() % 20);
                break;
            case 2:
                text.insert(at, text.substr(random() % text.size(), random() % 40));
                break;
            case 3:
                text.resize(at);
                break;
            default: {
                const std::size_t start = text.find_first_of("0123456789", at);
                if (start == std::string::npos) break;
                const std::size_t end = std::min(text.find_first_not_of("0123456789", start), text.size());
                text.replace(start, end - start, numbers[random() % numbers.size()]);
            }
        }
    }
    return text;
}

/// No more memory than there is now and so much on top, while it lives. Without effect under sanitizers,
/// which reserve more than any limit.
class MemoryLimit {
  public:
    explicit MemoryLimit(std::size_t bytes) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
        std::size_t pages = 0;
        std::ifstream("/proc/self/statm") >> pages;
        getrlimit(RLIMIT_AS, &before_);
        rlimit limit = before_;
        limit.rlim_cur = pages * 4096 + bytes;
        limited_ = setrlimit(RLIMIT_AS, &limit) == 0;
#else
        static_cast<void>(bytes);
#endif
    }
    ~MemoryLimit() {
        if (limited_) setrlimit(RLIMIT_AS, &before_);
    }
    MemoryLimit(const MemoryLimit&) = delete;
    MemoryLimit& operator=(const MemoryLimit&) = delete;

  private:
    rlimit before_{};
    bool limited_ = false;
};

/// Reading the file gives a result, or one line with the file's name in front and exit code 3, within two
/// seconds and 512 MB. Anything else that `read` throws, bad_alloc for one, ends the test.
template <class Read>
void expect_read_or_refused(const std::filesystem::path& path, const Read& read) {
    const MemoryLimit limit(std::size_t{512} << 20);
    const auto start = std::chrono::steady_clock::now();
    try {
        read(path);
    } catch (const Error& error) {
        EXPECT_EQ(exit_code(error.kind()), 3) << error.what();
        EXPECT_EQ(error.where().rfind(path.string(), 0), 0u) << error.what();
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    EXPECT_LT(taken.count(), 2.0);
}

}  // namespace hex::test
