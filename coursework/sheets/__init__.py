"""Content of sheets, before it is rendered: questions, answers, worked solutions."""
