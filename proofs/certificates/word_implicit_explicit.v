(* kickdrift word "K2(1/2) C1(1) K2(1/2)" --lambda1 1600 --lambda2 1 --h 3/2 --certificate word_implicit_explicit.v *)
From Coq Require Import Reals QArith.
From Kickdrift Require Import Vocabulary WordCertificate.

(** kind, the letters, then h, lambda1, lambda2. *)
Theorem kickdrift_word :
  word_verdict Elliptic [K Second [1 # 2]; C First (1 # 1); K Second [1 # 2]] (3 / 2) (1600 / 1) (1 / 1).
Proof. certify_word (3 # 2) (1600 # 1) (1 # 1). Qed.
Print Assumptions kickdrift_word.
