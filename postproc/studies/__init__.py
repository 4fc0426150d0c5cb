"""Modules of `study.py` that other scripts use too."""
