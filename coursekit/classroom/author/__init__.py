"""For authors of a course: solved notebooks, sample tables, releases, exports. No release holds it."""
