# What Canvas's importer of QTI (the gem `qti`, for New Quizzes) reads from packages: a line of JSON each.
#
#   ruby -I GEM/lib canvas_reads.rb FOLDER...
#
# FOLDER is a package, unpacked. The gem's dependencies come from the distribution (ruby-activesupport, ruby-actionview,
# ruby-zip, ruby-sanitize, ruby-dry-types); the two that it lacks are of no use to reading QTI 1.2 and stand in as empty ones.
require 'json'

def standing_in(name)
  require name
rescue LoadError
  yield
  $LOADED_FEATURES << "#{name}.rb"
end

require 'dry-types'
standing_in('dry-struct') do
  module Dry
    class Struct
      def self.method_missing(*) = self
      def self.respond_to_missing?(*) = true
    end
  end
end
standing_in('mathml2latex') do
  module Mathml2latex
    INSTUCTURE_LATEX_NS = 'none'.freeze
    class Converter
      def replace_with_latex(doc) = doc
    end
  end
end
module Kernel
  alias required require
  def require(name) = %w[dry-struct mathml2latex].include?(name) ? false : required(name)
end
require 'qti'

def item(made)
  model = made.interaction_model
  answers = model.respond_to?(:answers) ? model.answers.map { |a| [a.identifier, a.item_body] }.to_h : {}
  scored = made.scoring_data_structs
  {
    'identifier' => made.identifier, 'title' => made.title, 'points' => made.points_possible.to_f,
    'sort' => model.class.name.split('::').last, 'body' => made.item_body, 'answers' => answers,
    'scored' => scored.is_a?(Array) ? scored.map { |s| s.to_h } : [],
    'words' => (made.answer_feedback || []).map { |f| [f[:response_value], f[:feedback]] }.to_h
  }
end

ARGV.each do |folder|
  importer = Qti::Importer.new(folder)
  test = importer.test_object
  groups = importer.assessment_item_refs.map do |ref|
    group = importer.create_question_group(ref)
    made = group.items.map { |one| importer.create_assessment_item(one) }
    { 'title' => group.title, 'pick' => group.selection_number, 'points' => group.points_per_item,
      'items' => made.map { |one| item(one) } }
  end
  puts JSON.generate('title' => test.title, 'points' => test.canvas_points_possible,
                     'shuffled' => test.canvas_shuffle_answers?, 'groups' => groups)
end
