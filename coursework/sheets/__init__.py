"""What a sheet says, before it is rendered: questions, answers, worked solutions."""
