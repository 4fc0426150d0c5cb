#!/usr/bin/env python3
"""Tables in pages, ../page_tables.py: what is written, and whether the pages of this folder's neighbours have their scripts and all their rows."""
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import page_tables  # noqa: E402

PAGE = """# A page

<!-- table: other, by script.py -->
| a | b |
|---|---|
| 9 | 9 |
<!-- end of table -->

<!-- table: one, by script.py -->
| case | products | s |
|---|---|---|
| first | 10 | 1.0 |
| gone | 11 | 1.1 |
<!-- end of table -->

The end.
"""
HEAD = ["case", "products", "s"]


class Tables(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.TemporaryDirectory()
        self.page = pathlib.Path(self.directory.name) / "page.md"
        self.page.write_text(PAGE)

    def tearDown(self):
        self.directory.cleanup()

    def rows(self):
        return page_tables.read(self.page, "one")[1]

    def test_what_was_not_run_again_stays(self):
        page_tables.write(self.page, "one", HEAD, [["first", "12", None], ["second", "20", "2.0"]])
        self.assertEqual(self.rows(), [["first", "12", "1.0"], ["gone", "11", "1.1"], ["second", "20", "2.0"]])

    def test_rows_stand_in_the_order_of_the_cases_and_others_go(self):
        page_tables.write(self.page, "one", HEAD, [["zero", "5", "0.5"]], known=[("zero",), ("first",)])
        self.assertEqual(self.rows(), [["zero", "5", "0.5"], ["first", "10", "1.0"]])

    def test_other_columns_are_another_table(self):
        page_tables.write(self.page, "one", ["case", "GB"], [["first", "3"]])
        self.assertEqual(self.rows(), [["first", "3"]])

    def test_the_rest_of_the_page_stays(self):
        page_tables.write(self.page, "one", HEAD, [["first", "10", "1.0"], ["gone", "11", "1.1"]])
        self.assertEqual(self.page.read_text(), PAGE)

    def test_a_page_without_the_table_is_refused(self):
        with self.assertRaisesRegex(SystemExit, "no table two"):
            page_tables.write(self.page, "two", HEAD, [])

    def test_a_table_with_figures_wants_a_script(self):
        table = ["| deck | products |", "|---|---|", "| one | 10 |", "| two | no end |", "| three | some 20 |"]
        self.assertTrue(page_tables.wants_script(table, 1, in_regression=False))
        self.assertFalse(page_tables.wants_script(table[:-1], 1, in_regression=False))  # one cell
        self.assertFalse(page_tables.wants_script([page_tables.CONSTANTS, *table], 2, in_regression=False))
        names = ["| keyword | becomes |", "|---|---|", "| `*CLOAD` | a force, to 0.1 % |", "| `3` | [4](four.md) |"]
        self.assertFalse(page_tables.wants_script(names, 1, in_regression=False))
        self.assertTrue(page_tables.wants_script(names, 1, in_regression=True))
        self.assertFalse(page_tables.wants_script(["| file | holds |", *names[1:]], 1, in_regression=True))

    def test_the_pages_have_a_script_for_each_table_and_a_row_for_each_case(self):
        self.assertEqual(list(page_tables.check()), [])


if __name__ == "__main__":
    unittest.main()
