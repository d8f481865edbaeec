"""Foundations without mechanics of contact: arrays, checks, quantities, sources, validity, storage and executors."""
