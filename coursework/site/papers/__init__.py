"""Assignments for students: papers, submissions, receipts, and feedback."""
