"""What scripts/lint takes for a function, and what it says about lists of exceptions."""
import importlib.machinery
import importlib.util
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def load():
    loader = importlib.machinery.SourceFileLoader("lint", str(ROOT / "scripts" / "lint"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("lint", loader))
    loader.exec_module(module)
    return module


lint = load()
find = lint.functions.find


class Functions(unittest.TestCase):
    def test_free_functions_methods_and_constructors(self):
        self.assertEqual(find("namespace a::b {\nint f(int x) {\n    return x;\n}\n}\n"), [("f", 2, 4)])
        self.assertEqual(find("template <class T>\nvoid A<T>::g() const noexcept(true) {\n}\n")[0][1:], (1, 3))
        text = "struct A {\n    int x = {};\n    A(int i) : x{i}, y(2) {\n    }\n    bool operator()(int) { return 1; }\n};\n"
        self.assertEqual(find(text), [("A", 3, 4), ("operator()", 5, 5)])
        self.assertEqual(find("A::~A() {}\nauto f() -> std::vector<int> {\n}\n"), [("A::~A", 1, 1), ("f", 2, 3)])

    def test_what_is_no_function(self):
        for text in ("enum class E : int { A, B };", "int a[] = {1, 2};", "const S s{f(1)};", "struct S { int x{2}; };",
                     "class B : public A<int()> { };", "std::function<void()> f{};", "INSTANTIATE(All, [] { return 1; });"):
            self.assertEqual(find(text), [], text)

    def test_braces_that_are_text(self):
        self.assertEqual(find('void f() {\n  g("}", \'}\', 1\'000, R"x(})x}\n)x"); // }\n  /* } */\n}\nint x;\n'), [("f", 1, 5)])

    def test_both_branches_of_a_condition(self):
        self.assertEqual(find("#if A\nvoid f(int) {\n#else\nvoid f() {\n#endif\n    g();\n}\nvoid h() {}\n")[-1], ("h", 8, 8))

    def test_tests_and_lambdas(self):
        self.assertEqual(find("TEST(A, B) {\n  auto f = [] { return 1; };\n}\n"), [("TEST(A,B)", 1, 3)])
        self.assertEqual(find("const auto f = [](int x) {\n  return x;\n};\n"), [("f", 1, 3)])


class Exceptions(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        lint.ROOT = pathlib.Path(folder.name)
        (lint.ROOT / "scripts").mkdir()

    def messages(self, lines, listed, update=False, reason=" # a table"):
        if listed is not None:
            (lint.ROOT / lint.EXCEPTIONS).write_text(f"function {listed} a.cpp f{reason}\n" if listed else "")
        return lint.check_lengths({"a.cpp": "void f() {\n" + "\n" * (lines - 2) + "}\n"}, update)

    def test_limits(self):
        self.assertEqual(self.messages(80, 0), [])
        self.assertIn("function f of 81 lines", self.messages(81, 0)[0])
        self.assertIn("file of 501 lines", self.messages(501, 501)[0])

    def test_entries_only_shrink(self):
        self.assertEqual(self.messages(90, 90), [])
        self.assertIn("grew from 90 to 91", self.messages(91, 90)[0])
        self.assertIn("shrink the entry", self.messages(89, 90)[0])
        self.assertIn("shrink the entry", self.messages(80, 90)[0])

    def test_update_lowers_and_drops_but_does_not_add(self):
        self.assertEqual(self.messages(89, 90, update=True), [])
        self.assertEqual(self.messages(89, None), [])
        self.assertIn("grew", self.messages(95, None, update=True)[0])
        self.assertEqual(self.messages(70, None, update=True), [])
        self.assertIn("of 81 lines", self.messages(81, None)[0])

    def test_entries_have_reasons(self):
        self.assertEqual(len(self.messages(90, 90, reason="")), 1)
        self.assertIn("has no reason", self.messages(90, 90, reason="")[0])
        self.assertIn("has no reason", self.messages(90, 90, reason=" # ")[0])

    def test_update_keeps_reasons(self):
        self.messages(89, 90, update=True)
        self.assertEqual((lint.ROOT / lint.EXCEPTIONS).read_text(), lint.HEADER + "function 89 a.cpp f # a table\n")

    def test_numbers_of_functions_are_no_reasons(self):
        self.assertEqual(lint.parse_exceptions("function 90 a.cpp f#2\nfunction 91 a.cpp TEST(A,B) # one # two\n"),
                         {("function", "a.cpp", "f#2"): (90, ""), ("function", "a.cpp", "TEST(A,B)"): (91, "one # two")})


if __name__ == "__main__":
    unittest.main()
