#include <hex/base/registry.h>

#include <gtest/gtest.h>

namespace hex {
namespace {

struct Speaker {
    virtual ~Speaker() = default;
    virtual std::string speak() const = 0;
};
struct Dog : Speaker {
    std::string speak() const override { return "wuff"; }
};
struct Cat : Speaker {
    std::string speak() const override { return "miau"; }
};

/// Sets where methods come from for the life of the object.
struct Origin {
    explicit Origin(const std::string& origin) : old(registration_origin()) {
        registration_origin() = origin;
    }
    ~Origin() { registration_origin() = old; }
    std::string old;
};

TEST(Registry, MakesTheMethodOfAName) {
    Registry<Speaker> registry("speak");
    const Register<Speaker, Dog> dog(registry, "dog", "barks");
    const Register<Speaker, Cat> cat(registry, "cat", "mews");
    EXPECT_EQ(registry.make("dog")->speak(), "wuff");
    EXPECT_EQ(registry.make("cat")->speak(), "miau");
    EXPECT_TRUE(registry.contains("cat"));
    EXPECT_FALSE(registry.contains("cow"));
}

TEST(Registry, AnUnknownNameIsAUsageErrorThatListsTheKnownOnes) {
    Registry<Speaker> registry("speak");
    const Register<Speaker, Dog> dog(registry, "dog", "barks");
    const Register<Speaker, Cat> cat(registry, "cat", "mews");
    try {
        registry.make("cow");
        FAIL() << "made a cow";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        EXPECT_STREQ(error.what(), "stage 'speak' has no method 'cow'; known methods: cat, dog");
    }
}

TEST(Registry, ANameCanBeTakenOnce) {
    Registry<Speaker> registry("speak");
    const Register<Speaker, Dog> dog(registry, "dog", "barks");
    EXPECT_THROW((Register<Speaker, Cat>(registry, "dog", "mews")), Error);
    EXPECT_EQ(registry.make("dog")->speak(), "wuff");
}

TEST(Registry, AFactoryThatGivesNothingIsAnError) {
    Registry<Speaker> registry("speak");
    registry.add("mute", "gives no object", [] { return std::unique_ptr<Speaker>(); });
    try {
        registry.make("mute");
        FAIL() << "a null pointer was returned";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::no_result);
        EXPECT_NE(std::string(error.what()).find("mute"), std::string::npos);
    }
}

TEST(Registry, ListsMethodsByNameWithWhereTheyComeFrom) {
    Registry<Speaker> registry("speak");
    const Register<Speaker, Dog> dog(registry, "dog", "barks");
    {
        const Origin plugin("libcat.so");
        const Register<Speaker, Cat> cat(registry, "cat", "mews");
    }
    const auto methods = registry.list();
    ASSERT_EQ(methods.size(), 2u);
    EXPECT_EQ(methods[0].name, "cat");
    EXPECT_EQ(methods[0].origin, "libcat.so");
    EXPECT_EQ(methods[0].stage, "speak");
    EXPECT_EQ(methods[1].description, "barks");
    EXPECT_EQ(methods[1].origin, "built-in");
}

}  // namespace
}  // namespace hex
