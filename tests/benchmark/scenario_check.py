# SPDX-License-Identifier: Apache-2.0
"""Tests of the scenario matrix that run nothing: is the list as promised, does the summary say what is so?"""

import csv
import itertools
import tempfile
import unittest
from pathlib import Path

import scenario_report
from scenario_list import AXES, EACH_AT_LEAST, RESOLUTION, ROWS, SENSITIVITY, applies, coverage, pairs, scenarios

GOOD = {"status": "ok", "build": "1", "iou": 0.99, "f_half_voxel": 0.99, "f_voxel": 0.999, "components": 1,
        "open_edges": 0, "euler_number": 2, "genus": 0, "false_outside_volume_deep": 0,
        "false_inside_volume_deep": 0, "seconds": 1, "cpu_seconds": 1, "peak_memory_bytes": 1}


def all_good():
    return {(s.name, row): dict(GOOD) for s in scenarios() for row in ROWS if applies(s, row)}


def verdicts(results):
    return [demand.verdict for demand in scenario_report.demands(scenarios(), results)]


def demand(results, start):
    return next(d for d in scenario_report.demands(scenarios(), results) if d.title.startswith(start))


class List(unittest.TestCase):
    def test_every_value_of_every_axis_occurs_often_enough(self):
        for axis, values in coverage(scenarios()).items():
            for value, count in values.items():
                self.assertGreaterEqual(count, EACH_AT_LEAST, f"{axis} {value}")

    def test_every_pair_of_values_occurs(self):
        tried = set().union(*map(pairs, scenarios()))
        for (a, left), (b, right) in itertools.combinations(AXES.items(), 2):
            for pair in itertools.product(left, right):
                self.assertIn(((a, pair[0]), (b, pair[1])), tried)

    def test_it_is_the_same_each_time_without_repetition(self):
        self.assertEqual(scenarios(), scenarios.__wrapped__())
        self.assertEqual(len(set(scenarios())), len(scenarios()))
        self.assertLessEqual(len(scenarios()), 40)

    def test_hard_scans_are_seen_from_all_sides_too(self):
        self.assertTrue({"hard", "hardblind"} <= {s.data for s in scenarios() if s.from_all_sides})


class Summary(unittest.TestCase):
    def setUp(self):
        self.results = all_good()
        self.sides = [s.name for s in scenarios() if s.from_all_sides and s.scene != "anchor"]

    def test_all_is_met_when_all_is_good(self):
        self.assertEqual(set(verdicts(self.results)), {"met"})

    def test_nothing_run_is_nothing_met(self):
        self.assertEqual(set(verdicts({})), {"MISSING"})

    def test_each_missing_cell_is_missed_by_a_demand(self):
        asked_for = {s.name for s in scenarios() if s.from_all_sides}
        for key in [k for k in self.results if k[1] != "oracle" or k[0] in asked_for]:
            without = {k: r for k, r in self.results.items() if k != key}
            self.assertIn("MISSING", verdicts(without), key)

    def test_a_failed_default_is_not_met(self):
        self.results[self.sides[0], "default"] = {"status": "failed", "message": "it is empty"}
        self.assertEqual(demand(self.results, "default: one component").verdict, "NOT MET")
        self.assertIn("it is empty", scenario_report.summary(scenarios(), self.results))

    def test_a_second_component_and_an_open_edge_are_found(self):
        for key in ("components", "open_edges"):
            results = all_good()
            results[scenarios()[-1].name, "default"][key] += 1
            self.assertEqual(verdicts(results).count("NOT MET"), 1)

    def test_accuracy_is_measured_by_itself_and_by_the_oracle(self):
        self.results[self.sides[0], "default"]["f_voxel"] = 0.9949
        self.assertEqual(demand(self.results, "default, from all sides").verdict, "NOT MET")
        self.assertEqual(demand(self.results, "the same views").verdict, "met")
        self.results[self.sides[0], "oracle"]["f_voxel"] = 1.0
        self.assertEqual(demand(self.results, "the same views").verdict, "NOT MET")

    def test_the_anchor_is_measured_by_the_oracle_alone(self):
        anchor = next(s.name for s in scenarios() if s.from_all_sides and s.scene == "anchor")
        self.results[anchor, "default"]["f_voxel"] = self.results[anchor, "oracle"]["f_voxel"] = 0.9
        self.assertEqual(set(verdicts(self.results)), {"met"})

    def test_who_is_better_by_more_than_the_margin_is_named(self):
        self.results[self.sides[0], "tsdf"]["iou"] = 0.9949
        self.assertEqual(demand(self.results, "default nowhere below tsdf").verdict, "met")
        self.results[self.sides[0], "tsdf"]["iou"] = 0.9951
        self.assertIn(self.sides[0], demand(self.results, "default nowhere below tsdf").text())
        self.assertEqual(demand(self.results, "default nowhere below paper").verdict, "met")

    def test_who_fails_is_not_better(self):
        self.results[self.sides[0], "paper"] = {"status": "failed", "message": "it is empty"}
        self.assertEqual(demand(self.results, "default nowhere below paper").verdict, "met")

    def test_the_worst_regret_is_stated_first_and_without_the_oracle(self):
        self.results[self.sides[1], "no-denial"]["iou"] = 0.993
        self.results[self.sides[2], "oracle"]["iou"] = 1.0
        worst = demand(self.results, "worst regret").remarks[0]
        self.assertEqual(worst, f"0.0030 IoU: {self.sides[1]}, against no-denial")

    def test_sensitivity_counts_to_either_side(self):
        for sign in (-1, 1):
            results = all_good()
            results[self.sides[0], list(SENSITIVITY)[0]]["iou"] += 0.021 * sign
            self.assertEqual(demand(results, "lambda").verdict, "NOT MET")

    def test_another_genus_at_another_resolution_is_found(self):
        self.results[self.sides[0], list(RESOLUTION)[2]]["genus"] = 1
        self.assertEqual(demand(self.results, "128").verdict, "NOT MET")

    def test_results_of_two_builds_are_not_taken_for_one(self):
        self.assertNotIn("CAREFUL", scenario_report.summary(scenarios(), self.results))
        self.results[self.sides[0], "tsdf"]["build"] = "2"
        self.assertIn("CAREFUL", scenario_report.summary(scenarios(), self.results))

    def test_the_table_has_a_line_a_cell(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "matrix.csv"
            scenario_report.write_csv(path, scenarios(), self.results)
            with open(path, newline="") as file:
                lines = list(csv.DictReader(file))
        self.assertEqual(len(lines), len(self.results))
        self.assertEqual((lines[0]["row"], lines[0]["iou"]), ("default", "0.99"))


def run():
    from scenarios import print_coverage
    print_coverage(scenarios())
    tests = unittest.defaultTestLoader.loadTestsFromModule(__import__("scenario_check"))
    return 0 if unittest.TextTestRunner().run(tests).wasSuccessful() else 1
